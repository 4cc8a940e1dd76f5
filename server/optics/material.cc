#include "optics/material.h"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"
#include "optics/presets.h"
#include "optics/profile.h"

namespace diaphane::optics {
namespace {

// So that a black channel is still a profile.
constexpr double kLowestAlbedo = 1e-6;

constexpr double kLowestExtinction_mm = 1e-3, kHighestExtinction_mm = 1e3;

constexpr const char* kChannels[] = {"red", "green", "blue"};

/// Sets a channel's coefficients by its extinction σ't and the share 1 − α' of it that is absorbed.
void set_channel(Coefficients* coefficients, int c, double extinction_mm, double absorbed) {
  const double share = std::min(absorbed, 1 - kLowestAlbedo);
  coefficients->absorption_mm[c] = static_cast<float>(share * extinction_mm);
  coefficients->reduced_scattering_mm[c] = static_cast<float>((1 - share) * extinction_mm);
}

Coefficients invert(const DiffuseColor& form, Profile profile) {
  Coefficients coefficients{.refractive_index = form.refractive_index};
  for (int c = 0; c < 3; ++c) {
    set_channel(&coefficients, c, 1 / double{form.mean_free_path_mm[c]},
                absorbed_share(profile, form.color[c], form.refractive_index));
  }
  return coefficients;
}

/// The single-scattering albedo at which a half-space has the diffuse albedo `color`: Kulla and Conty 2017's fit, with
/// the similarity relation for the anisotropy.
double single_scattering_albedo(double color, double anisotropy) {
  const double s = 4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
  return std::clamp((1 - s * s) / (1 - anisotropy * s * s), 0.0, 1.0);
}

Coefficients map_volume(const Volume& form, std::vector<std::string>* warnings) {
  Coefficients coefficients{.refractive_index = form.refractive_index};
  const double g = form.scatter_anisotropy;
  for (int c = 0; c < 3; ++c) {
    const double extinction = -std::log(double{form.attenuation_color[c]}) / form.attenuation_distance_mm;
    const double albedo = single_scattering_albedo(form.multiscatter_color[c], g);
    const double scattering = (1 - g) * albedo, absorption = 1 - albedo;  // in units of σt
    const double reduced = (scattering + absorption) * extinction;
    const double kept = std::clamp(reduced, kLowestExtinction_mm, kHighestExtinction_mm);
    if (kept != reduced) {
      warnings->push_back(
          fmt::format("volume: the attenuation in {} gives a reduced extinction of {:.3g} mm^-1, which is beyond "
                      "0.001..1000 and taken as {:g}",
                      kChannels[c], reduced, kept));
    }
    set_channel(&coefficients, c, kept, absorption / (scattering + absorption));
  }
  return coefficients;
}

void warn_of_albedo(const Coefficients& coefficients, std::vector<std::string>* warnings) {
  const double bound = lowest_albedo(coefficients.profile);
  for (int c = 0; c < 3; ++c) {
    const double scattering = coefficients.reduced_scattering_mm[c];
    const double albedo = scattering / (scattering + double{coefficients.absorption_mm[c]});
    // A hair below, so that what is meant to be at the bound is not warned of for its rounding.
    if (albedo >= bound - 1e-4) continue;
    warnings->push_back(
        fmt::format("{} scatters too little for diffusion: its reduced albedo is {:.3g}, below {:.3g}, where diffuse "
                    "light would fall off faster than light that is not scattered at all; how light spreads in this "
                    "channel is only roughly right",
                    kChannels[c], albedo, bound));
  }
}

}  // namespace

double lowest_albedo(Profile profile) {
  switch (profile) {
    case Profile::kBetterDipole:
      return 0.5;
    case Profile::kNormalizedDiffusion:
      return 0;
    case Profile::kDipole:
      break;
  }
  return 2.0 / 3.0;
}

double absorbed_share(Profile profile, double color, double refractive_index) {
  // In √(1 − α'), in which the reflectance falls smoothly from 1 at 0 to 0 at 1. Bisection to the last bits: it is done
  // once per material, and there is nothing to guard.
  double low = 0, high = 1;
  for (int step = 0; step < 52; ++step) {
    const double middle = 0.5 * (low + high);
    (total_reflectance(profile, middle * middle, refractive_index) > color ? low : high) = middle;
  }
  return high * high;
}

ResolvedMaterial resolve(const MaterialForm& form, Profile profile) {
  ResolvedMaterial resolved;
  Coefficients& coefficients = resolved.coefficients;
  if (const auto* preset = std::get_if<PresetName>(&form)) {
    coefficients = find_preset(preset->name).value_or(*find_preset("marble")).coefficients;
  } else if (const auto* color = std::get_if<DiffuseColor>(&form)) {
    coefficients = invert(*color, profile);
  } else if (const auto* volume = std::get_if<Volume>(&form)) {
    coefficients = map_volume(*volume, &resolved.warnings);
  } else {
    coefficients = std::get<Coefficients>(form);
  }
  coefficients.profile = profile;
  warn_of_albedo(coefficients, &resolved.warnings);
  return resolved;
}

}  // namespace diaphane::optics

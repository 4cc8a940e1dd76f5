#include "optics/profile.h"

#include <cmath>
#include <numbers>

namespace diaphane::optics {
namespace {

using std::numbers::pi;

/// What of l/s stands for z in normalized diffusion.
constexpr double kSmoothShareOfLength = 1.0;

/// One channel's coefficients, as the formulae want them.
struct Medium {
  double mean_free_path_mm;  ///< l
  double absorbed;           ///< 1 − α'
  double refractive_index;
};

double integral_over_plane(const ProfileTerm& term) {
  const double flux = term.height_mm > 0 ? term.flux_mm / term.height_mm : 0;
  return 2 * pi * (flux + term.fluence_mm / term.transport_mm) * std::exp(-term.transport_mm * term.height_mm);
}

double dipole_total(double absorbed, double refractive_index) {
  const double root = std::sqrt(3 * absorbed);
  const double mismatch = boundary_mismatch(static_cast<float>(refractive_index));
  return (1 - absorbed) / 2 * (1 + std::exp(-4.0 / 3.0 * mismatch * root)) * std::exp(-root);
}

ChannelProfile dipole(const Medium& medium) {
  const double l = medium.mean_free_path_mm, scale = (1 - medium.absorbed) / (4 * pi);
  const double transport = std::sqrt(3 * medium.absorbed) / l;
  const double image = l * (1 + 4 * double{boundary_mismatch(static_cast<float>(medium.refractive_index))} / 3);
  return {.terms = {{{l, transport, scale * l, 0}, {image, transport, scale * image, 0}}},
          .total = dipole_total(medium.absorbed, medium.refractive_index),
          .smooth_mm = l / (1 + transport * l / 3)};
}

/// d'Eon 2012, A Better Dipole, its Rd.
ChannelProfile better_dipole(const Medium& medium) {
  const double l = medium.mean_free_path_mm, albedo = 1 - medium.absorbed;
  const double diffusion = (1 + medium.absorbed) * l / 3;  // (2σa + σ's)/(3σ't²)
  const double transport = std::sqrt(3 * medium.absorbed / (1 + medium.absorbed)) / l;
  const double moment1 = fresnel_moment(1, medium.refractive_index);
  const double moment2 = fresnel_moment(2, medium.refractive_index);
  const double of_fluence = 0.25 * (1 - 2 * moment1), of_flux = 0.5 * (1 - 3 * moment2);
  const double image = l + 4 * diffusion * (1 + 3 * moment2) / (1 - 2 * moment1);
  const double flux = albedo * albedo * of_flux / (4 * pi);
  const double fluence = albedo * albedo * of_fluence / (4 * pi * diffusion);
  ChannelProfile profile{.terms = {{{l, transport, flux * l, fluence}, {image, transport, flux * image, -fluence}}},
                         .smooth_mm = l / (1 + transport * l / 3)};
  // The two terms' fluences over σ, without the difference of large numbers where nothing is absorbed.
  const double between = transport > 0 ? -std::expm1(-transport * (image - l)) / transport : image - l;
  profile.total =
      2 * pi * std::exp(-transport * l) * (flux * (1 + std::exp(-transport * (image - l))) + fluence * between);
  return profile;
}

ChannelProfile normalized_diffusion(const Medium& medium) {
  const double colour = dipole_total(medium.absorbed, medium.refractive_index);
  const double s = 1.9 - colour + 3.5 * (colour - 0.8) * (colour - 0.8);
  const double length = medium.mean_free_path_mm / s;
  const double fluence = colour / (8 * pi * length);
  ChannelProfile profile{.terms = {{{0, 1 / length, 0, fluence}, {0, 1 / (3 * length), 0, fluence}}},
                         .smooth_mm = kSmoothShareOfLength * length};
  profile.total = integral_over_plane(profile.terms[0]) + integral_over_plane(profile.terms[1]);
  return profile;
}

ChannelProfile profile_of(Profile profile, const Medium& medium) {
  switch (profile) {
    case Profile::kBetterDipole:
      return better_dipole(medium);
    case Profile::kNormalizedDiffusion:
      return normalized_diffusion(medium);
    case Profile::kDipole:
      break;
  }
  return dipole(medium);
}

Medium medium_of(const Coefficients& material, int channel) {
  const double absorption = material.absorption_mm[channel];
  const double extinction = absorption + double{material.reduced_scattering_mm[channel]};
  return {1 / extinction, absorption / extinction, material.refractive_index};
}

}  // namespace

double fresnel_moment(int order, double refractive_index) {
  if (refractive_index <= 1) return 0;
  // All is reflected up to the critical angle; beyond it by the outer cosine c: μ dμ = c dc/η², and F is the same from
  // both sides. Simpson.
  const double eta2 = refractive_index * refractive_index;
  double sum = 0;
  constexpr int kIntervals = 128;
  for (int i = 0; i <= kIntervals; ++i) {
    const double c = static_cast<double>(i) / kIntervals;
    const double inside = std::sqrt(1 - (1 - c * c) / eta2);
    const double reflected =
        1 - double{fresnel_transmittance(static_cast<float>(refractive_index), static_cast<float>(c))};
    const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * reflected * c / eta2 * std::pow(inside, order - 1);
  }
  const double critical = std::sqrt(1 - 1 / eta2);
  return std::pow(critical, order + 1) / (order + 1) + sum / (3.0 * kIntervals);
}

ReflectanceProfile make_profile(const Coefficients& material) {
  ReflectanceProfile profile;
  for (int c = 0; c < 3; ++c) {
    profile[static_cast<size_t>(c)] = profile_of(material.profile, medium_of(material, c));
  }
  return profile;
}

glm::vec3 diffuse_reflectance(const ReflectanceProfile& profile, float distance_mm) {
  glm::vec3 rd;
  for (int c = 0; c < 3; ++c) {
    double sum = 0;
    for (const ProfileTerm& term : profile[static_cast<size_t>(c)].terms) {
      const double d = std::hypot(double{distance_mm}, term.height_mm), depth = term.transport_mm * d;
      sum += (term.flux_mm * (1 + depth) / (d * d * d) + term.fluence_mm / d) * std::exp(-depth);
    }
    rd[c] = static_cast<float>(sum);
  }
  return rd;
}

glm::vec3 total_reflectance(const Coefficients& material) {
  glm::vec3 total;
  for (int c = 0; c < 3; ++c) {
    total[c] = static_cast<float>(profile_of(material.profile, medium_of(material, c)).total);
  }
  return total;
}

double total_reflectance(Profile profile, double absorbed, double refractive_index) {
  return profile_of(profile, {1, absorbed, refractive_index}).total;
}

}  // namespace diaphane::optics

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "diaphane/framing.h"
#include "fmt/format.h"
#include "gallery/figures.h"
#include "gallery/morph.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 40;
constexpr size_t kColumns = 5;
constexpr float kSteps[] = {0, 0.5f, 1};
constexpr float kGlaze = 0.05f;

Rgb mixed(const Rgb& a, const Rgb& b, float t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/// A terrace at dusk: a sky that glows over the horizon, a warm floor of boards, a low sun, a row of lit windows.
EnvironmentMap terrace() {
  constexpr uint32_t kWidth = 512, kHeight = 256;
  constexpr float kPi = std::numbers::pi_v<float>;
  EnvironmentMap map{kWidth, kHeight, {}};
  map.radiance.reserve(size_t{kWidth} * kHeight);
  for (uint32_t row = 0; row < kHeight; ++row) {
    for (uint32_t column = 0; column < kWidth; ++column) {
      const float elevation = kPi * (0.5f - (static_cast<float>(row) + 0.5f) / kHeight);
      const float azimuth = 2 * kPi * ((static_cast<float>(column) + 0.5f) / kWidth - 0.5f);  // from -z to +x
      Rgb colour;
      if (elevation > 0) {
        colour = mixed({0.5f, 0.33f, 0.22f}, {0.09f, 0.16f, 0.36f}, std::sqrt(elevation / (kPi / 2)));
      } else {
        const bool gap = std::fmod(azimuth + kPi, kPi / 16) < 0.02f;
        colour = gap ? Rgb{0.03f, 0.02f, 0.02f} : Rgb{0.14f, 0.09f, 0.06f};
      }
      // The house stands behind the eye, around +z.
      const float behind = kPi - std::abs(azimuth);
      if (behind < 0.9f && std::abs(elevation) < 0.5f) {
        const bool window = std::fmod(behind, 0.3f) > 0.1f && elevation > 0 && elevation < 0.35f;
        colour = window ? Rgb{3.5f, 2.6f, 1.5f} : Rgb{0.12f, 0.1f, 0.09f};
      }
      if (std::hypot(azimuth + 2.0f, elevation - 0.5f) < 0.06f) colour = {90, 70, 45};
      map.radiance.push_back(colour);
    }
  }
  return map;
}

absl::StatusOr<Still> in_terrace(const FigureOptions& options, const Material& material, uint32_t size_px) {
  absl::StatusOr<Still> still = portrait(options.mesh, material, kHeight_mm, size_px);
  if (still.ok()) still->environment = terrace();
  return still;
}

RenderSettings before_the_terrace() {
  RenderSettings settings = by_integral();
  settings.environment_background = true;
  settings.samples = 4;
  return settings;
}

Material porcelain(std::optional<Coat> coat) { return {"porcelain", Profile::kDipole, coat}; }

absl::Status add_morph(const Studio& studio, const FigureOptions& options, Section* section, double* ev) {
  absl::StatusOr<Still> still = in_terrace(options, porcelain(Coat{kGlaze}), options.size_px);
  if (!still.ok()) return still.status();
  const absl::StatusOr<Sphere> sphere = bounding_sphere(options.mesh);
  if (!sphere.ok()) return sphere.status();
  const auto& [c, r] = *sphere;
  still->camera = frame_camera({{c.x - r, c.y - r, c.z - r}, {c.x + r, c.y + r, c.z + r}}, {.aspect = 1, .fill = 1});
  for (const float t : kSteps) still->poses.push_back(morphed(options.mesh.positions, *sphere, t));
  const RenderSettings settings[] = {by_integral(), before_the_terrace()};
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
  if (!frames.ok()) return frames.status();
  // By the body alone.
  const LinearFrame* body = &frames->front();
  *ev = exposure_for({&body, 1});
  section->rows.emplace_back();
  for (size_t i = 0; i < std::size(kSteps); ++i) {
    const int percent = static_cast<int>(std::lround(100 * kSteps[i]));
    section->rows.back().push_back({fmt::format("fig11_{:03}", percent), developed(frames->at(2 * i + 1), *ev),
                                    fmt::format("{} %, {}", percent, stops(*ev))});
  }
  return absl::OkStatus();
}

absl::Status add_coats(const Studio& studio, const FigureOptions& options, double ev, Section* section) {
  struct Entry {
    const char* name;
    const char* caption;
    std::optional<Coat> coat;
  };
  const Entry entries[] = {{"none", "no coat", std::nullopt},
                           {"rough", "coat, roughness 0.4", Coat{0.4f}},
                           {"mirror", "coat, roughness 0: a mirror", Coat{0}}};
  section->rows.emplace_back();
  for (const Entry& entry : entries) {
    const absl::StatusOr<Still> still = in_terrace(options, porcelain(entry.coat), options.size_px);
    if (!still.ok()) return still.status();
    const RenderSettings settings[] = {by_integral(), before_the_terrace()};
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
    if (!frames.ok()) return frames.status();
    section->rows.back().push_back({fmt::format("coat_{}", entry.name), developed(frames->at(1), ev), entry.caption});
    section->facts["mean_luminance"][entry.name] = mean_luminance(frames->front());
  }
  return absl::OkStatus();
}

absl::Status add_presets(const Studio& studio, const FigureOptions& options, double ev, Section* section) {
  const absl::StatusOr<std::vector<MaterialPreset>> presets = studio.client().material_presets();
  if (!presets.ok()) return presets.status();
  const size_t first_row = section->rows.size();
  for (const MaterialPreset& preset : *presets) {
    const absl::StatusOr<Still> still = in_terrace(options, {preset.name}, options.size_px * 3 / 4);
    if (!still.ok()) return still.status();
    const RenderSettings settings[] = {before_the_terrace()};
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
    if (!frames.ok()) return frames.status();
    if (section->rows.size() == first_row || section->rows.back().size() == kColumns) section->rows.emplace_back();
    section->rows.back().push_back({"environment_" + preset.name, developed(frames->front(), ev), preset.name});
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Section> figure_environment(const Studio& studio, const FigureOptions& options) {
  Section section{.id = "fig11", .title = "Fig. 11: porcelain in an environment"};
  section.paragraphs = {
      fmt::format("The paper shows a porcelain body that changes its shape in an environment. Here: {} mm high, glazed "
                  "by a coat of roughness {}, on its way to its bounding sphere, on a terrace at dusk that is made by "
                  "this program. Its sun is taken out as a light with a shadow, the rest enters through 25 "
                  "harmonics, and the coat shows the map itself.",
                  kHeight_mm, kGlaze),
      "Below: the coat off, rough, and smooth. It adds what does not enter, so the body below is the same in all "
      "three. "
      "Last: every preset there, without a coat. All by the integral, at one exposure."};
  double ev = 0;
  if (absl::Status status = add_morph(studio, options, &section, &ev); !status.ok()) return status;
  if (absl::Status status = add_coats(studio, options, ev, &section); !status.ok()) return status;
  if (absl::Status status = add_presets(studio, options, ev, &section); !status.ok()) return status;
  return section;
}

}  // namespace diaphane::gallery

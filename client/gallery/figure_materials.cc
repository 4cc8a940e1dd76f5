#include "diaphane/framing.h"
#include "fmt/format.h"
#include "gallery/figures.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 20;
constexpr size_t kColumns = 5;

std::string caption_of(const MaterialPreset& preset) {
  const auto& [absorption, scattering, refractive_index] = preset.coefficients;
  return fmt::format("{}: σ's {} {} {}, σa {} {} {} mm⁻¹, η {}; {}", preset.name, scattering.r, scattering.g,
                     scattering.b, absorption.r, absorption.g, absorption.b, refractive_index, preset.source);
}

}  // namespace

absl::StatusOr<Section> figure_materials(const Studio& studio, const FigureOptions& options) {
  const absl::StatusOr<std::vector<MaterialPreset>> presets = studio.client().material_presets();
  if (!presets.ok()) return presets.status();
  Section section{.id = "materials", .title = "All presets"};
  section.paragraphs = {
      fmt::format("Every named material on one mesh {} mm high, by the integral, a lamp on the upper left and a weaker "
                  "one behind, all at one exposure. The measured ones are Jensen, Marschner, Levoy and Hanrahan's "
                  "(2001); wax and porcelain, which the paper shows without figures, are ours.",
                  kHeight_mm)};
  section.facts["names"] = nlohmann::json::array();
  const RenderSettings settings[] = {by_integral()};
  double ev = 0;
  for (const MaterialPreset& preset : *presets) {
    absl::StatusOr<Still> still = portrait(options.mesh, {preset.name}, kHeight_mm, options.size_px * 3 / 4);
    if (!still.ok()) return still.status();
    if (absl::Status lit = add_lamp({-0.6f, 0.7f, 0.8f}, 2.5f, &*still); !lit.ok()) return lit;
    if (absl::Status lit = add_lamp({0.8f, 0.4f, -1}, 2, &*still); !lit.ok()) return lit;
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
    if (!frames.ok()) return frames.status();
    const LinearFrame& frame = frames->front();
    if (section.rows.empty() || section.rows.back().size() == kColumns) section.rows.emplace_back();
    section.rows.back().push_back({"material_" + preset.name, developed(frame, ev), caption_of(preset)});
    section.facts["names"].push_back(preset.name);
  }
  return section;
}

}  // namespace diaphane::gallery

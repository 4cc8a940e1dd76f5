#include <iterator>

#include "diaphane/framing.h"
#include "diaphane/scene.h"
#include "fmt/format.h"
#include "gallery/figures.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 20;

struct Entry {
  const char* name;
  Rgb color;
  float mean_free_path_mm;
  Profile profile = Profile::kDipole;
};

constexpr Rgb kRose{0.85f, 0.55f, 0.45f};
// Two rows.
constexpr Entry kEntries[] = {
    {"white", {0.95f, 0.95f, 0.95f}, 1},
    {"sand", {0.8f, 0.6f, 0.35f}, 1},
    {"jade", {0.25f, 0.65f, 0.4f}, 1},
    {"blue", {0.1f, 0.25f, 0.7f}, 1},
    {"ink", {0.02f, 0.02f, 0.05f}, 1},
    {"rose_short", kRose, 0.3f},
    {"rose", kRose, 1},
    {"rose_long", kRose, 3},
    {"rose_better", kRose, 1, Profile::kBetterDipole},
    {"rose_normalized", kRose, 1, Profile::kNormalizedDiffusion},
};
constexpr size_t kColumns = std::size(kEntries) / 2;

std::string_view name_of(Profile profile) {
  for (const NamedProfile& named : kProfiles) {
    if (named.profile == profile) return named.name;
  }
  return "";
}

std::string rgb(const Rgb& value) { return fmt::format("{:.4g} {:.4g} {:.4g}", value.r, value.g, value.b); }

Material material_of(const Entry& entry) {
  const float l = entry.mean_free_path_mm;
  return {DiffuseColor{entry.color, {l, l, l}}, entry.profile};
}

}  // namespace

absl::StatusOr<Section> figure_colors(const Studio& studio, const FigureOptions& options) {
  Section section{.id = "colors", .title = "Materials by colour"};
  section.paragraphs = {
      fmt::format(
          "Bodies {} mm high of which only the colour under even light and the mean free path l were given; the "
          "table has the coefficients that they came to. Above: five colours, l = 1 mm. Below: one colour at "
          "three l, and by the other two profiles. By the integral, one lamp on the upper left and a weaker "
          "one behind, one exposure.",
          kHeight_mm),
      "Under an even light all bodies of the lower row would be of one colour. Under lamps a longer l carries light "
      "farther, from lit parts into dark ones and out of thin ones."};
  section.table = {{"", "colour", "l, mm", "profile", "σ's, mm⁻¹", "σa, mm⁻¹", "warnings"}};
  const absl::StatusOr<Scene> scene = studio.client().create_scene({});
  if (!scene.ok()) return scene.status();
  const RenderSettings settings[] = {by_integral()};
  for (const Entry& entry : kEntries) {
    absl::StatusOr<Still> still = portrait(options.mesh, material_of(entry), kHeight_mm, options.size_px * 3 / 4);
    if (!still.ok()) return still.status();
    if (absl::Status lit = add_lamp({-0.6f, 0.7f, 0.8f}, 2.5f, &*still); !lit.ok()) return lit;
    if (absl::Status lit = add_lamp({0.8f, 0.4f, -1}, 2, &*still); !lit.ok()) return lit;
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
    if (!frames.ok()) return frames.status();
    const absl::StatusOr<MaterialHandle> handle = scene->add_material(material_of(entry));
    if (!handle.ok()) return handle.status();
    const absl::StatusOr<MaterialInfo> info = scene->material(*handle);
    if (!info.ok()) return info.status();
    const std::string caption =
        fmt::format("{}, l {} mm, {}", rgb(entry.color), entry.mean_free_path_mm, name_of(entry.profile));
    if (section.rows.empty() || section.rows.back().size() == kColumns) section.rows.emplace_back();
    section.rows.back().push_back({fmt::format("color_{}", entry.name), developed(frames->front(), 0), caption});
    section.table.push_back({entry.name, rgb(entry.color), fmt::format("{}", entry.mean_free_path_mm),
                             std::string(name_of(entry.profile)), rgb(info->resolved.reduced_scattering_mm),
                             rgb(info->resolved.absorption_mm), fmt::format("{}", info->warnings.size())});
    section.facts["warnings"][entry.name] = info->warnings;
  }
  if (absl::Status removed = scene->remove(); !removed.ok()) return removed;
  return section;
}

}  // namespace diaphane::gallery

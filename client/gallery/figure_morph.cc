#include <cmath>

#include "diaphane/framing.h"
#include "fmt/format.h"
#include "gallery/figures.h"
#include "gallery/horned_head.h"
#include "gallery/morph.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 12;
constexpr float kGlobalGain = 100;
constexpr float kSteps[] = {0, 0.35f, 0.7f, 1};

// Told of the body at rest, whatever it has become.
Region at_rest(bool (*region)(const Vec3&), const Sphere& sphere, float t) {
  return [=](const Vec3& p) { return region(unmorphed(p, sphere, t)); };
}

}  // namespace

absl::StatusOr<Section> figure_morph(const Studio& studio, const FigureOptions& options) {
  const MeshData head = horned_head(options.head_levels);
  const Sphere sphere = bounding_sphere_around({}, head);
  absl::StatusOr<Still> still = portrait(head, {"skimmilk"}, kHeight_mm, options.size_px);
  if (!still.ok()) return still.status();
  const auto& [c, r] = sphere;
  // The sphere must fit, and the lamp stand outside it.
  still->camera = frame_camera({{c.x - r, c.y - r, c.z - r}, {c.x + r, c.y + r, c.z + r}}, {.aspect = 1, .fill = 1});
  if (absl::Status lit = add_lamp({0.3f, 0.5f, -1}, 0.75f, &*still); !lit.ok()) return lit;
  for (const float t : kSteps) still->poses.push_back(morphed(head.positions, sphere, t));
  const RenderSettings settings[] = {by_paper({.global_gain = kGlobalGain}), by_integral()};
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
  if (!frames.ok()) return frames.status();

  Section section{.id = "fig10", .title = "Fig. 10: a morph, lit from behind", .rows = {{}, {}}};
  section.paragraphs = {
      "The paper turns a highly translucent body into its bounding sphere, lit from behind by a point light: thin "
      "parts stay brighter than thick ones while the shape changes, since nothing was computed beforehand.",
      fmt::format(
          "Here: the horned head in skim milk, {} mm high, the lamp behind. Positions alone were sent for each "
          "step. Rows: integral, paper (its global term {} times amplified, and red since it grows with the cube of "
          "a channel's mean free path), each at one exposure throughout. The table compares the parts that were "
          "horns with those that were skull, before they have become the sphere.",
          kHeight_mm, kGlobalGain)};
  section.table = {{"technique", "step", "horns over skull, mean luminance"}};
  const char* names[] = {"integral", "paper"};
  for (size_t row = 0; row < 2; ++row) {
    const size_t offset = row == 0 ? 1 : 0;  // frames come paper first
    const LinearFrame* first = &frames->at(offset);
    const double ev = exposure_for({&first, 1});
    for (size_t step = 0; step < std::size(kSteps); ++step) {
      const LinearFrame& frame = frames->at(2 * step + offset);
      const int percent = static_cast<int>(std::lround(100 * kSteps[step]));
      section.rows[row].push_back({fmt::format("fig10_{}_{:03}", names[row], percent), developed(frame, ev),
                                   fmt::format("{}, {} %, {}", names[row], percent, stops(ev))});
      if (kSteps[step] == 1) continue;
      const double ratio = mean_luminance(frame, at_rest(on_horn, sphere, kSteps[step])) /
                           mean_luminance(frame, at_rest(on_skull, sphere, kSteps[step]));
      section.table.push_back({names[row], fmt::format("{} %", percent), fmt::format("{:.1f}", ratio)});
      section.facts["horns_over_skull"][names[row]][fmt::format("{}", percent)] = ratio;
    }
  }
  return section;
}

}  // namespace diaphane::gallery

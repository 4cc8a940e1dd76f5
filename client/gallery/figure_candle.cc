#include <cmath>

#include "fmt/format.h"
#include "gallery/candle.h"
#include "gallery/figures.h"

namespace diaphane::gallery {
namespace {

constexpr Coefficients kRedWax{{0.004f, 0.14f, 0.2f}, {1.3f, 1.15f, 1.05f}, 1.4f};
constexpr Coefficients kWick{{4, 4, 4}, {0.4f, 0.35f, 0.3f}, 1.4f};
constexpr Rgb kFlame{60, 45, 26};  // W·sr⁻¹
constexpr float kFlameRadius_mm = 1.2f;
constexpr float kGlobalGain = 1000;

// On the wall, by height over the foot as a share of the candle's.
Region wall_between(const CandleShape& shape, float from, float to) {
  return [=](const Vec3& p) {
    return std::hypot(p.x, p.z) > shape.radius - 0.5f * shape.wall && p.y > from * shape.height &&
           p.y < to * shape.height;
  };
}

}  // namespace

absl::StatusOr<Section> figure_candle(const Studio& studio, const FigureOptions& options) {
  const CandleShape shape;
  Still still;
  still.bodies = {{candle(shape), {kRedWax}}, {wick(shape), {kWick}}};
  still.millimetres_per_unit = 1;
  still.lights = {PointLight{flame(shape), kFlame, kFlameRadius_mm}};
  still.camera = {{0, 62, 100}, {0, 19.5f, 0}, {0, 1, 0}, 24};
  still.size = {options.size_px, options.size_px * 5 / 4};
  const RenderSettings settings[] = {by_paper({.global_gain = kGlobalGain}), by_integral()};
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(still, settings);
  if (!frames.ok()) return frames.status();

  Section section{.id = "fig7", .title = "Fig. 7: a candle lit by its flame", .rows = {{}}};
  section.paragraphs = {
      "The paper's red wax candle is lit by one point light, its flame. Wax spreads light widely: the candle glows "
      "around the flame, red, and darkens towards its foot.",
      "Here the candle is a mesh of this program's own: 38 mm high, the rim molten around a hollow 9 mm deep, with "
      "a wick in it. The flame is a warm point light of 1.2 mm radius above the wick and below the rim, so within "
      "the body's outline. The flame itself is not drawn. Red wax is ours: σa = (0.004, 0.14, 0.2), σ's = (1.3, "
      "1.15, 1.05) mm⁻¹.",
      "What counts as light is what enters the surface from outside. By the integral it enters through the hollow, "
      "and through the wick's shadow less; the outer wall, which faces away from the flame, shows what came through "
      "the wax. A light that stood within the wax itself would enter nowhere, and leave the picture black.",
      fmt::format("By paper the wall glows by the global term alone, which takes |N·ω| at the point itself and the "
                  "distance to the flame; it is amplified {} times, and knows nothing of the wax between.",
                  kGlobalGain)};
  section.table = {{"technique", "wall by the flame over wall at the foot, luminance"}};
  const char* names[] = {"paper", "integral"};
  for (size_t i = 0; i < frames->size(); ++i) {
    const LinearFrame* frame = &frames->at(i);
    const double ev = exposure_for({&frame, 1});
    section.rows[0].push_back(
        {fmt::format("fig7_{}", names[i]), developed(*frame, ev), fmt::format("{}, {}", names[i], stops(ev))});
    const double ratio = mean_luminance(*frame, wall_between(shape, 0.75f, 0.95f)) /
                         mean_luminance(*frame, wall_between(shape, 0.05f, 0.25f));
    section.table.push_back({names[i], fmt::format("{:.1f}", ratio)});
    section.facts["flame_over_foot"][names[i]] = ratio;
  }
  return section;
}

}  // namespace diaphane::gallery

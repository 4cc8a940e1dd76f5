#include "fmt/format.h"
#include "gallery/figures.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 10;
// The caption's figures with its two columns swapped: as printed, nothing would scatter.
constexpr Coefficients kCaption{{0.00162f, 0.00053f, 0.00024f}, {2.58f, 2.54f, 1.6f}, 1.3f};

}  // namespace

absl::StatusOr<Section> figure_opaque(const Studio& studio, const FigureOptions& options) {
  absl::StatusOr<Still> still = portrait(options.mesh, {kCaption}, kHeight_mm, options.size_px);
  if (!still.ok()) return still.status();
  if (absl::Status lit = add_lamp({-1, 0.5f, -0.1f}, 1.5f, &*still); !lit.ok()) return lit;
  RenderSettings opaque;
  opaque.technique = Technique::kLambert;
  opaque.shadows = Shadows::kOn;
  const RenderSettings settings[] = {by_paper(), by_integral(), opaque};
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
  if (!frames.ok()) return frames.status();

  Section section{.id = "fig8", .title = "Fig. 8: translucent and opaque", .rows = {{}}};
  section.paragraphs = {
      "The paper sets a translucent body beside one without light inside: what is translucent looks softer, and its "
      "small details are blurred.",
      fmt::format(
          "Here: {} mm high, a lamp on the left, σ's = (2.58, 2.54, 1.6), σa = (0.00162, 0.00053, 0.00024) mm⁻¹. "
          "Those are the figures of the paper's caption with its two columns swapped: as printed, next to nothing "
          "would scatter. The opaque body is matt (lambert), with shadows. Each picture at its own exposure.",
          kHeight_mm)};
  const char* names[] = {"paper", "integral", "lambert"};
  const char* captions[] = {"translucent, paper", "translucent, integral", "opaque, lambert"};
  for (size_t i = 0; i < frames->size(); ++i) {
    const LinearFrame* frame = &frames->at(i);
    const double ev = exposure_for({&frame, 1});
    section.rows[0].push_back(
        {fmt::format("fig8_{}", names[i]), developed(*frame, ev), fmt::format("{}, {}", captions[i], stops(ev))});
  }
  return section;
}

}  // namespace diaphane::gallery

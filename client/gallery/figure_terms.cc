#include "fmt/format.h"
#include "gallery/figures.h"
#include "gallery/horned_head.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 12;
constexpr float kGlobalGain = 100;

}  // namespace

absl::StatusOr<Section> figure_terms(const Studio& studio, const FigureOptions& options) {
  absl::StatusOr<Still> still = portrait(horned_head(options.head_levels), {"wax"}, kHeight_mm, options.size_px);
  if (!still.ok()) return still.status();
  if (absl::Status lit = add_lamp({0.25f, 0.7f, -0.75f}, 0.75f, &*still); !lit.ok()) return lit;
  const RenderSettings settings[] = {by_paper({.terms = Terms::kLocal, .global_gain = kGlobalGain}),
                                     by_paper({.terms = Terms::kGlobal, .global_gain = kGlobalGain}),
                                     by_paper({.terms = Terms::kBoth, .global_gain = kGlobalGain}), by_integral()};
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
  if (!frames.ok()) return frames.status();

  Section section{.id = "fig9", .title = "Fig. 9: local, global, both", .rows = {{}}};
  section.paragraphs = {
      "The paper's demon: with the local term alone the thickness of its horns does not show; the global term makes "
      "thin parts brighter, and the sum looks right.",
      fmt::format(
          "Here: a horned head of this program's own in wax, {} mm high, lit from behind and above. Local light "
          "stays on the side that the lamp sees. The global term of the paper falls with the cube of the distance "
          "to the lamp: within {} mm it is still so dark that it is amplified {} times here. The three pictures by "
          "paper share one exposure. The integral has no terms: light that enters behind comes out in front, and "
          "more of it where there is less in between.",
          kHeight_mm, kHeight_mm, kGlobalGain)};
  section.paragraphs.push_back(
      "The hatching on the inner sides of the horns, the ears and the face is the kernel's: each of its few taps "
      "repeats "
      "the thin lit strip along an edge. More taps make it finer.");
  const LinearFrame* of_paper = &frames->at(2);
  const LinearFrame* of_integral = &frames->at(3);
  const double paper_ev = exposure_for({&of_paper, 1});
  const double integral_ev = exposure_for({&of_integral, 1});
  const char* names[] = {"local", "global", "both", "integral"};
  const char* captions[] = {"paper, local", "paper, global", "paper, both", "integral"};
  section.table = {{"picture", "horns over skull, mean luminance"}};
  for (size_t i = 0; i < frames->size(); ++i) {
    const LinearFrame& frame = frames->at(i);
    const double ev = i == 3 ? integral_ev : paper_ev;
    section.rows[0].push_back(
        {fmt::format("fig9_{}", names[i]), developed(frame, ev), fmt::format("{}, {}", captions[i], stops(ev))});
    const double skull = mean_luminance(frame, on_skull);
    const double ratio = skull > 0 ? mean_luminance(frame, on_horn) / skull : 0;
    section.table.push_back({captions[i], fmt::format("{:.1f}", ratio)});
    section.facts["horns_over_skull"][names[i]] = ratio;
  }
  return section;
}

}  // namespace diaphane::gallery

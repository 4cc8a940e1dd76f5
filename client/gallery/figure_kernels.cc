#include <algorithm>

#include "fmt/format.h"
#include "gallery/figures.h"
#include "gallery/histogram.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 10;
constexpr uint32_t kSmallest = 3;
constexpr uint32_t kLargest = 6;

}  // namespace

absl::StatusOr<Section> figure_kernels(const Studio& studio, const FigureOptions& options) {
  absl::StatusOr<Still> still = portrait(options.mesh, {"wax"}, kHeight_mm, options.size_px);
  if (!still.ok()) return still.status();
  if (absl::Status lit = add_lamp({-0.8f, 0.7f, 0.5f}, 2, &*still); !lit.ok()) return lit;
  std::vector<RenderSettings> settings;
  for (uint32_t taps = kSmallest; taps <= kLargest; ++taps) settings.push_back(by_paper({.kernel_taps = taps}));
  settings.push_back(by_integral());
  const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, settings);
  if (!frames.ok()) return frames.status();

  const LinearFrame& integral = frames->back();
  const LinearFrame* of_paper = &frames->at(frames->size() - 2);
  const double paper_ev = exposure_for({&of_paper, 1});
  const LinearFrame* of_integral = &integral;
  const double integral_ev = exposure_for({&of_integral, 1});
  std::vector<Histogram> histograms;
  double highest = 0;
  for (const LinearFrame& frame : *frames) {
    histograms.push_back(luma_histogram(frame, &frame == &integral ? integral_ev : paper_ev));
    highest = std::max(highest, *std::max_element(histograms.back().begin(), histograms.back().end()));
  }

  Section section{.id = "fig6", .title = "Fig. 6: kernels", .rows = {{}, {}}};
  section.paragraphs = {
      "The paper gathers light with a kernel of N×N texels around each point's place on its cube face, and looks "
      "for the N from which the picture no longer changes: by the histograms of its pictures, 5×5 and 6×6 are alike.",
      fmt::format(
          "Here: wax, {} mm high, a lamp on the upper left. The taps of every kernel span the same width, the mean "
          "free path times N·f, so that a larger kernel samples the same light more finely. Below each picture is "
          "the histogram of its luma, dark to bright; the pictures by paper are developed at {}. The table says how "
          "far a histogram is from the next: the mean shift, in levels of 255, that makes the one into the other.",
          kHeight_mm, stops(paper_ev)),
      fmt::format(
          "At the right is the integral over the whole surface, at {}: what the kernels do not reach, since one "
          "mean free path holds a part of the light alone.",
          stops(integral_ev))};
  section.table = {{"from", "to", "levels apart"}};
  const int size = static_cast<int>(options.size_px);
  for (size_t i = 0; i < frames->size(); ++i) {
    const bool last = i + 1 == frames->size();
    const uint32_t taps = kSmallest + static_cast<uint32_t>(i);
    const std::string name = last ? "integral" : fmt::format("kernel_{}", taps);
    const std::string label = last ? "integral" : fmt::format("paper, {0}×{0}", taps);
    section.rows[0].push_back({"fig6_" + name, developed(frames->at(i), last ? integral_ev : paper_ev), label});
    section.rows[1].push_back({"fig6_" + name + "_histogram", drawn(histograms[i], highest, size, size / 3), "luma"});
    if (last || i == 0) continue;
    const double apart = levels_apart(histograms[i - 1], histograms[i]);
    section.table.push_back(
        {fmt::format("{0}×{0}", taps - 1), fmt::format("{0}×{0}", taps), fmt::format("{:.2f}", apart)});
    section.facts["levels_apart"][fmt::format("{}_{}", taps - 1, taps)] = apart;
  }
  return section;
}

}  // namespace diaphane::gallery

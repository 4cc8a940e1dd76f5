#include "fmt/format.h"
#include "gallery/errors.h"
#include "gallery/figures.h"
#include "gallery/horned_head.h"

namespace diaphane::gallery {
namespace {

constexpr double kPaperFull_percent = 200;
constexpr double kIntegralFull_percent = 5;
constexpr int kScaleHeight_px = 14;

struct Case {
  std::string name;
  std::string caption;
  Still still;
};

absl::StatusOr<std::vector<Case>> cases(const FigureOptions& options) {
  absl::StatusOr<Still> front = portrait(options.mesh, {"marble"}, 20, options.reference_px);
  if (!front.ok()) return front.status();
  if (absl::Status lit = add_lamp({-0.6f, 0.7f, 0.8f}, 2.5f, &*front); !lit.ok()) return lit;
  absl::StatusOr<Still> back = portrait(horned_head(options.head_levels), {"skin1"}, 12, options.reference_px);
  if (!back.ok()) return back.status();
  if (absl::Status lit = add_lamp({0.6f, 0.5f, -1}, 2, &*back); !lit.ok()) return lit;
  return std::vector<Case>{{"front", "marble, 20 mm, lit from the front", *std::move(front)},
                           {"back", "skin1, 12 mm, lit from behind", *std::move(back)}};
}

void show_error(const Case& shown, const char* technique, const LinearFrame& frame, const LinearFrame& right,
                double full_percent, std::vector<Shot>* row, Section* section) {
  row->push_back({fmt::format("error_{}_{}", shown.name, technique), error_picture(frame, right, full_percent),
                  fmt::format("error of {}, 0 to {} %", technique, full_percent)});
  const Errors errors = errors_of(frame, right);
  section->table.push_back(
      {shown.caption, technique,
       fmt::format("{:.2f} {:.2f} {:.2f} %", errors.rms_percent.r, errors.rms_percent.g, errors.rms_percent.b),
       fmt::format("{:.1f} %", errors.percentile_99_9), fmt::format("{:.1f} %", errors.largest)});
  section->facts["rms_percent"][shown.name][technique] = {errors.rms_percent.r, errors.rms_percent.g,
                                                          errors.rms_percent.b};
}

}  // namespace

absl::StatusOr<Section> figure_techniques(const Studio& studio, const FigureOptions& options) {
  const absl::StatusOr<std::vector<Case>> all = cases(options);
  if (!all.ok()) return all.status();
  Section section{.id = "techniques", .title = "Techniques and their errors"};
  section.paragraphs = {
      "The reference sums the same dipole over the whole surface at every pixel; it takes seconds to minutes, and "
      "judges the others. No shadows in any of these, and one exposure for all three.",
      "Errors are differences of radiance in the worst channel, in per cent of the reference's mean in that channel "
      "over the body. The colours run from no error at the left of the scale to the largest that it shows at its "
      "right, and everything beyond."};
  section.table = {{"", "technique", "RMS R, G, B", "99.9th percentile", "largest"}};
  RenderSettings paper = by_paper();
  RenderSettings integral = by_integral();
  RenderSettings reference;
  reference.technique = Technique::kReference;
  for (RenderSettings* one : {&paper, &integral, &reference}) one->shadows = Shadows::kOff;
  for (const Case& shown : *all) {
    const RenderSettings settings[] = {paper, integral, reference};
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(shown.still, settings);
    if (!frames.ok()) return frames.status();
    const LinearFrame* right = &frames->back();
    const double ev = exposure_for({&right, 1});
    std::vector<Shot> row;
    const char* names[] = {"paper", "integral", "reference"};
    for (size_t i = 0; i < frames->size(); ++i) {
      row.push_back({fmt::format("technique_{}_{}", shown.name, names[i]), developed(frames->at(i), ev),
                     fmt::format("{}: {}", names[i], shown.caption)});
    }
    show_error(shown, names[0], frames->at(0), *right, kPaperFull_percent, &row, &section);
    show_error(shown, names[1], frames->at(1), *right, kIntegralFull_percent, &row, &section);
    section.rows.push_back(std::move(row));
  }
  section.rows.push_back(
      {{"error_scale", colour_scale(static_cast<int>(options.reference_px), kScaleHeight_px),
        fmt::format("none … {} % (paper) or {} % (integral)", kPaperFull_percent, kIntegralFull_percent)}});
  return section;
}

}  // namespace diaphane::gallery

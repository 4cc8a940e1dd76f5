#include "media/sheet.h"

#include <algorithm>

#include "OpenImageIO/imagebuf.h"
#include "OpenImageIO/imagebufalgo.h"
#include "fmt/format.h"

namespace diaphane::media {
namespace {

constexpr int kGap_px = 4;
constexpr int kText_px = 12;
constexpr int kLine_px = 18;
constexpr float kLightGrey[] = {0.82f, 0.82f, 0.84f, 1};

// Cut at the end, with dots, to what fits.
std::string fitted(const std::string& text, int width_px) {
  if (text_width_px(text, kText_px) <= width_px) return text;
  std::string cut = text;
  while (!cut.empty() && text_width_px(cut + "...", kText_px) > width_px) cut.pop_back();
  return cut + "...";
}

absl::Status draw_cell(const Cell& cell, int x, int y, const SheetOptions& options, Picture& sheet) {
  const Picture small = shrunk(cell.picture, options.cell_px);
  draw_over(small, x + (options.cell_px - small.width_px) / 2, y + (options.cell_px - small.height_px) / 2, sheet);
  if (!options.labels || cell.label.empty()) return absl::OkStatus();
  return draw_text(fitted(cell.label, options.cell_px), x, y + options.cell_px + kText_px, kText_px, sheet);
}

}  // namespace

absl::StatusOr<Picture> contact_sheet(std::span<const std::vector<Cell>> series, const SheetOptions& options) {
  int rows = 0;
  int columns = 0;
  for (const std::vector<Cell>& cells : series) {
    rows += (static_cast<int>(cells.size()) + options.columns - 1) / options.columns;
    columns = std::max(columns, std::min(options.columns, static_cast<int>(cells.size())));
  }
  if (rows == 0) return absl::InvalidArgumentError("sheet: must have a picture, got none");
  const int across = options.cell_px + kGap_px;
  const int down = across + (options.labels ? kLine_px : 0);
  Picture sheet = filled(columns * across + kGap_px, rows * down + kGap_px, kBackground);
  int row = 0;
  for (const std::vector<Cell>& cells : series) {
    for (size_t i = 0; i < cells.size(); ++i) {
      const int column = static_cast<int>(i) % options.columns;
      if (i > 0 && column == 0) ++row;
      const absl::Status drawn = draw_cell(cells[i], kGap_px + column * across, kGap_px + row * down, options, sheet);
      if (!drawn.ok()) return drawn;
    }
    if (!cells.empty()) ++row;
  }
  return sheet;
}

absl::Status draw_text(const std::string& text, int x, int y, int size_px, Picture& onto) {
  OIIO::ImageBuf image(OIIO::ImageSpec(onto.width_px, onto.height_px, 4, OIIO::TypeDesc::UINT8), onto.rgba.data());
  if (OIIO::ImageBufAlgo::render_text(image, x, y, text, size_px, kFont, kLightGrey)) return absl::OkStatus();
  return absl::UnavailableError(fmt::format("{}: no text can be drawn: {}", kFont, image.geterror()));
}

int text_width_px(const std::string& text, int size_px) {
  const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, size_px, kFont);
  return box.defined() ? box.width() : 0;
}

}  // namespace diaphane::media

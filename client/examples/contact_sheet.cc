#include "contact_sheet.h"

#include <algorithm>

#include "OpenImageIO/imagebuf.h"
#include "OpenImageIO/imagebufalgo.h"

namespace diaphane::examples {
namespace {

constexpr float kBackground[] = {0.16f, 0.16f, 0.17f, 1};  // sRGB
constexpr int kGapPx = 4;
constexpr int kColumns = 8;

// Draws one picture, shrunk, in the middle of the cell whose upper left corner is (x, y).
std::string draw(const std::filesystem::path& picture, int x, int y, int cell_px, OIIO::ImageBuf& sheet) {
  OIIO::ImageBuf frame(picture.string());  // alpha becomes associated on reading, which over() needs
  if (!frame.read(0, 0, true, OIIO::TypeDesc::FLOAT)) return frame.geterror();
  const double scale = std::min(1.0, cell_px / static_cast<double>(std::max(frame.spec().width, frame.spec().height)));
  const int width = std::max(1, static_cast<int>(frame.spec().width * scale));
  const int height = std::max(1, static_cast<int>(frame.spec().height * scale));
  const OIIO::ImageBuf small = OIIO::ImageBufAlgo::resize(frame, "", 0, {0, width, 0, height, 0, 1, 0, 4});
  x += (cell_px - width) / 2;
  y += (cell_px - height) / 2;
  const OIIO::ImageBuf under = OIIO::ImageBufAlgo::cut(sheet, {x, x + width, y, y + height, 0, 1, 0, 4});
  const OIIO::ImageBuf together = OIIO::ImageBufAlgo::over(small, under);
  if (together.has_error()) return together.geterror();
  return OIIO::ImageBufAlgo::paste(sheet, x, y, 0, 0, together) ? "" : sheet.geterror();
}

}  // namespace

std::string write_contact_sheet(const std::vector<std::vector<std::filesystem::path>>& series, uint32_t cell_px,
                                const std::filesystem::path& output) {
  const int cell = static_cast<int>(cell_px);
  const int stride = cell + kGapPx;
  int rows = 0;
  for (const auto& pictures : series) rows += (static_cast<int>(pictures.size()) + kColumns - 1) / kColumns;
  if (rows == 0) return "no pictures";
  OIIO::ImageBuf sheet(OIIO::ImageSpec(kColumns * stride + kGapPx, rows * stride + kGapPx, 4, OIIO::TypeDesc::FLOAT));
  OIIO::ImageBufAlgo::fill(sheet, kBackground);
  int row = 0;
  for (const auto& pictures : series) {
    int column = 0;
    for (const auto& picture : pictures) {
      if (column == kColumns) {
        column = 0;
        ++row;
      }
      std::string error = draw(picture, kGapPx + column * stride, kGapPx + row * stride, cell, sheet);
      if (!error.empty()) return error;
      ++column;
    }
    ++row;
  }
  if (!sheet.write(output.string(), OIIO::TypeDesc::UINT8)) return sheet.geterror();
  return {};
}

}  // namespace diaphane::examples

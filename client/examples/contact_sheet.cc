#include "contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "OpenImageIO/imagebuf.h"
#include "OpenImageIO/imagebufalgo.h"

namespace diaphane::examples {
namespace {

constexpr float kBackground[] = {0.16f, 0.16f, 0.17f, 1};  // sRGB
constexpr int kGapPx = 4;

}  // namespace

std::string write_contact_sheet(const std::vector<std::filesystem::path>& frames, uint32_t cell_px,
                                const std::filesystem::path& output) {
  if (frames.empty()) return "no frames";
  const int cell = static_cast<int>(cell_px) + kGapPx;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(frames.size()) * 1.5)));
  const int rows = (static_cast<int>(frames.size()) + columns - 1) / columns;
  OIIO::ImageBuf sheet(OIIO::ImageSpec(columns * cell + kGapPx, rows * cell + kGapPx, 4, OIIO::TypeDesc::FLOAT));
  OIIO::ImageBufAlgo::fill(sheet, kBackground);

  for (size_t i = 0; i < frames.size(); ++i) {
    OIIO::ImageBuf frame(frames[i].string());  // alpha becomes associated on reading, which over() needs
    if (!frame.read(0, 0, true, OIIO::TypeDesc::FLOAT)) return frame.geterror();
    const double scale =
        std::min(1.0, cell_px / static_cast<double>(std::max(frame.spec().width, frame.spec().height)));
    const int width = std::max(1, static_cast<int>(frame.spec().width * scale));
    const int height = std::max(1, static_cast<int>(frame.spec().height * scale));
    const OIIO::ImageBuf small = OIIO::ImageBufAlgo::resize(frame, "", 0, {0, width, 0, height, 0, 1, 0, 4});
    const int x = kGapPx + static_cast<int>(i) % columns * cell + (static_cast<int>(cell_px) - width) / 2;
    const int y = kGapPx + static_cast<int>(i) / columns * cell + (static_cast<int>(cell_px) - height) / 2;
    const OIIO::ImageBuf under = OIIO::ImageBufAlgo::cut(sheet, {x, x + width, y, y + height, 0, 1, 0, 4});
    const OIIO::ImageBuf together = OIIO::ImageBufAlgo::over(small, under);
    if (together.has_error() || !OIIO::ImageBufAlgo::paste(sheet, x, y, 0, 0, together)) return sheet.geterror();
  }
  if (!sheet.write(output.string(), OIIO::TypeDesc::UINT8)) return sheet.geterror();
  return {};
}

}  // namespace diaphane::examples

// Many pictures on one page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "media/picture.h"

namespace diaphane::media {

struct Cell {
  Picture picture;
  std::string label;  ///< below the picture; one line, cut to the cell's width; may be empty
};

struct SheetOptions {
  int cell_px = 192;  ///< pictures are shrunk to it
  int columns = 8;
  bool labels = false;  ///< leaves room for them
};

/// Lays the pictures out over the background, row by row, each series on rows of its own.
///
/// Errors: INVALID_ARGUMENT no picture; UNAVAILABLE a label without a font (kFont).
absl::StatusOr<Picture> contact_sheet(std::span<const std::vector<Cell>> series, const SheetOptions& options);

/// Of Debian's package fonts-dejavu-core.
inline constexpr char kFont[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// Draws one line of text with its baseline's left end at (x, y), in light grey.
///
/// Errors: UNAVAILABLE, see kFont.
absl::Status draw_text(const std::string& text, int x, int y, int size_px, Picture& onto);

/// How wide it would be, in pixels; 0 without a font.
int text_width_px(const std::string& text, int size_px);

}  // namespace diaphane::media

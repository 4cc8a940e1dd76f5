// Pictures in a terminal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "absl/functional/function_ref.h"
#include "diaphane/render_options.h"
#include "diaphane/texture.h"
#include "diaphane/values.h"

namespace diaphane::cli {

/// How a terminal is told of pixels.
enum class PictureProtocol {
  kKitty,  ///< kitty's graphics protocol: kitty, Ghostty, Konsole
  kITerm,  ///< iTerm2's inline images: iTerm2, WezTerm, mintty
  kBlocks  ///< two pixels a cell, as coloured half blocks: any terminal of 24-bit colour
};

std::optional<PictureProtocol> picture_protocol_of(std::string_view name);
/// The names, with " | " between them.
std::string picture_protocol_names();

/// By the variables that terminals set; `variable` gives one's value, or null. What is not known gets blocks.
PictureProtocol found_picture_protocol(absl::FunctionRef<const char*(const char*)> variable);

/// Of a terminal's window.
struct TerminalExtent {
  uint32_t columns = 80;
  uint32_t rows = 24;
  uint32_t width_px = 0;  ///< 0: it does not say
  uint32_t height_px = 0;

  friend bool operator==(const TerminalExtent&, const TerminalExtent&) = default;
};

/// What is asked of the server for a picture that fills all rows but the last; no side longer than 1024.
Size picture_size(PictureProtocol protocol, const TerminalExtent& extent);
/// What frames come as while things move.
ImageFormat picture_format(PictureProtocol protocol);

/// Draws a PNG (or, kITerm, JPEG) over all rows but the last, from the upper left corner. kKitty or kITerm.
std::string picture_text(PictureProtocol protocol, std::string_view file, const TerminalExtent& extent);
/// Draws an even number of rows of pixels from the upper left corner, one column a pixel, over black.
std::string blocks_text(const TextureData& picture);

}  // namespace diaphane::cli

// 8-bit pictures in memory: read, written, put together. Plain values; functions are thread-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace diaphane::media {

/// sRGB with unassociated alpha, four bytes a pixel, rows from the top.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<uint8_t> rgba;
};

/// An opaque colour, sRGB.
struct Colour {
  uint8_t r = 0;
  uint8_t g = 0;
  uint8_t b = 0;
};

/// The dark grey that pictures lie on.
inline constexpr Colour kBackground{41, 41, 43};

/// A picture that is `colour` all over.
Picture filled(int width_px, int height_px, const Colour& colour);

/// Decodes a PNG or JPEG file's bytes.
///
/// Errors: INVALID_ARGUMENT when they are none, or hold more than 8192 pixels a side.
absl::StatusOr<Picture> decode_picture(std::string_view file);

/// Errors: DATA_LOSS, with the path, when it cannot be written.
absl::Status write_png(const Picture& picture, const std::filesystem::path& path);

/// Lays `picture`, by its alpha, over `under` with its upper left corner at (x, y); what stands out is cut off.
void draw_over(const Picture& picture, int x, int y, Picture& under);

/// The same size, opaque.
Picture over(const Picture& picture, const Colour& background);

/// Side by side from the left, over the background, as high as the highest.
Picture beside(std::span<const Picture> pictures);

/// Shrunk, in proportion, until no side is longer than `longest_px`; a smaller picture as it is.
Picture shrunk(const Picture& picture, int longest_px);

}  // namespace diaphane::media

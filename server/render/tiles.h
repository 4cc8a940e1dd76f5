// Pictures larger than a render target, piece by piece.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "absl/status/status.h"

namespace diaphane::render {

/// Larger pictures are drawn tile by tile, so that targets stay small whatever is asked for.
inline constexpr uint32_t kTile_px = 2048;

/// A piece of a picture. x and y count from its lowest-left corner.
struct Tile {
  uint32_t x_px, y_px, width_px, height_px;
};

/// Where row `row` of `tile`, from its lowest, begins in a picture whose pixels count from the top left.
inline size_t first_pixel(uint32_t width_px, uint32_t height_px, const Tile& tile, uint32_t row) {
  return size_t{height_px - 1 - tile.y_px - row} * width_px + tile.x_px;
}

/// Calls `draw` for every tile until one fails.
template <typename Draw>
absl::Status for_each_tile(uint32_t width_px, uint32_t height_px, Draw&& draw) {
  for (uint32_t y = 0; y < height_px; y += kTile_px) {
    for (uint32_t x = 0; x < width_px; x += kTile_px) {
      const Tile tile{x, y, std::min(kTile_px, width_px - x), std::min(kTile_px, height_px - y)};
      if (absl::Status drawn = draw(tile); !drawn.ok()) return drawn;
    }
  }
  return absl::OkStatus();
}

/// A picture in memory, rows top to bottom.
struct Canvas {
  uint8_t* bytes;
  uint32_t width_px;
  uint32_t height_px;
  size_t bytes_per_pixel;
};

/// Copies a tile's pixels, rows bottom to top and `pixel_bytes` each, to the first bytes of their place.
void place_tile(const Canvas& canvas, const Tile& tile, const uint8_t* pixels, size_t pixel_bytes);

}  // namespace diaphane::render

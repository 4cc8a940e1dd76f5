#include "render/tiles.h"

#include <cstring>

namespace diaphane::render {

void place_tile(const Canvas& canvas, const Tile& tile, const uint8_t* pixels) {
  const size_t row_bytes = tile.width_px * canvas.bytes_per_pixel;
  for (uint32_t row = 0; row < tile.height_px; ++row) {
    const size_t y_from_top = canvas.height_px - 1 - tile.y_px - row;
    std::memcpy(canvas.bytes + (y_from_top * canvas.width_px + tile.x_px) * canvas.bytes_per_pixel,
                pixels + row * row_bytes, row_bytes);
  }
}

}  // namespace diaphane::render

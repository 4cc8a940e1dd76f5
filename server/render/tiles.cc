#include "render/tiles.h"

#include <cstring>

namespace diaphane::render {

void place_tile(const Canvas& canvas, const Tile& tile, const uint8_t* pixels, size_t pixel_bytes) {
  const size_t row_bytes = tile.width_px * pixel_bytes;
  for (uint32_t row = 0; row < tile.height_px; ++row) {
    uint8_t* to = canvas.bytes + first_pixel(canvas.width_px, canvas.height_px, tile, row) * canvas.bytes_per_pixel;
    const uint8_t* from = pixels + row * row_bytes;
    if (pixel_bytes == canvas.bytes_per_pixel) {
      std::memcpy(to, from, row_bytes);
      continue;
    }
    for (uint32_t x = 0; x < tile.width_px; ++x) {
      std::memcpy(to + x * canvas.bytes_per_pixel, from + x * pixel_bytes, pixel_bytes);
    }
  }
}

}  // namespace diaphane::render

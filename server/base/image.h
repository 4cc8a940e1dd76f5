// Pixels in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace diaphane::base {

/// An 8-bit image: rows top to bottom, RGBA interleaved, sRGB-encoded colour, unassociated alpha.
struct Image8 {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<uint8_t> rgba;
};

/// A float image: rows top to bottom, `channels` interleaved and named ("R", "G", "B", "A", "Z", ...), linear.
struct ImageF {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<std::string> channels;
  std::vector<float> values;
};

}  // namespace diaphane::base

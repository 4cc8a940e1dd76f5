// Where in a pixel it is sampled.
#pragma once

#include <bit>
#include <cstdint>

#include "glm/vec2.hpp"

namespace diaphane::render {

/// Sample `i` of `count` (1..64), within 0..1 of a pixel's width and height: Hammersley's points, so that any row and
/// any column of the pixel holds its share. One sample is the centre.
inline glm::vec2 sample_place(uint32_t i, uint32_t count) {
  const auto bits = static_cast<uint32_t>(std::bit_width(count - 1));
  uint32_t reversed = 0;
  for (uint32_t b = 0; b < bits; ++b) reversed |= (i >> b & 1) << (bits - 1 - b);
  return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
          (static_cast<float>(reversed) + 0.5f) / static_cast<float>(1u << bits)};
}

}  // namespace diaphane::render

// Triangles onto a raster, many at once: most of ours cover a few pixels, and a branch for each would cost more than
// they do.
#pragma once

#include <cstdint>
#include <span>

#include "glm/vec3.hpp"
#include "render/raster_candidates.h"

namespace diaphane::render {

/// One side of a raster: visible_key()s row by row, and which triangles it shows.
struct RasterSide {
  uint64_t* cells = nullptr;  ///< null: no such side
  bool counter_clockwise = false;
  bool clockwise = false;
};

/// Depths of corners, three numbers apart as their places are. The front is seen by their size, the back by
/// `whole` less that.
struct CornerDepths {
  const float* real = nullptr;
  const int32_t* integer = nullptr;  ///< in place of `real`
  float whole = 0;
};

/// Raises the cells that the triangles cover; see cover() and visible_key(). `candidates`: indices of `triangles` as
/// find_candidates() gives them, with what room they have behind them. Keys name `first_index` more than the index.
/// Thread-safe, for threads that raise the same cells too.
void draw_triangles(std::span<const glm::uvec3> triangles, std::span<const uint32_t> candidates, uint32_t first_index,
                    const CornerPlaces& corners, const CornerDepths& depths, const RasterSide& front,
                    const RasterSide& back);

}  // namespace diaphane::render

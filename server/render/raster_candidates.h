// Which of many small triangles have a pixel's centre within their bounds: few, and the others should cost little.
#pragma once

#include <cstdint>
#include <span>

#include "glm/vec3.hpp"

namespace diaphane::render {

/// What triangles are asked on. Corner i is at (x[3i], y[3i]), in 1/256 px.
struct CornerPlaces {
  const int32_t* x;
  const int32_t* y;
  int32_t width_px, height_px;
};

enum class Turn { kEither, kCounterClockwise, kClockwise };

/// Writes the indices of the triangles from `begin` to before `end` that may cover a pixel and run as asked, in order,
/// and returns their number. `candidates` has room for all of them and 16 more. Places are within ±2^24. Thread-safe.
size_t find_candidates(std::span<const glm::uvec3> triangles, size_t begin, size_t end, const CornerPlaces& corners,
                       Turn turn, uint32_t* candidates);

/// The same on three square rasters, each seen along an axis of `corners`, three numbers a corner: candidates[axis] may
/// cover a pixel there, however they run, and `counts` says how many they are.
void find_candidates_by_axis(std::span<const glm::uvec3> triangles, size_t begin, size_t end, const int32_t* corners,
                             int32_t size_px, uint32_t* const (&candidates)[3], size_t (&counts)[3]);

}  // namespace diaphane::render

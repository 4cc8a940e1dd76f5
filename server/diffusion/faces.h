// What the triangles of a surface give to their vertices: areas, directions, centroids.
#pragma once

#include <span>

#include "glm/vec3.hpp"

namespace diaphane::diffusion {

/// Vertices add these up; eight floats. The last one is zero.
struct Face {
  glm::vec3 area_vector_mm2{0};  ///< half the cross product of two edges
  float area_mm2 = 0;
  glm::vec3 weighted_mm3{0};  ///< centroid times area
  float unused = 0;
};

/// Fills faces[i] for triangles[i] (into `positions_mm`). Thread-safe.
void measure_faces(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions_mm,
                   std::span<Face> faces);

}  // namespace diaphane::diffusion

// What a mesh carries for the look of its surface, whatever shape it takes.
#pragma once

#include <vector>

#include "glm/vec2.hpp"
#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// One value a vertex of the uploaded mesh, or none. Immutable once shared.
struct SurfaceAttributes {
  std::vector<glm::vec2> texture_coordinates;  ///< [vertex_count] or empty; 0, 0 is the picture's upper left
  std::vector<glm::vec3> colors;               ///< [vertex_count] or empty; linear RGB, each 0..1

  bool empty() const { return texture_coordinates.empty() && colors.empty(); }
};

}  // namespace diaphane::geometry

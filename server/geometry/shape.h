// Where a mesh is at one moment: positions and normals of its vertices.
#pragma once

#include <span>
#include <vector>

#include "geometry/topology.h"
#include "glm/mat4x4.hpp"
#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// Positions of a MeshTopology's vertices, and their normals where the client gave some. Immutable once shared.
struct MeshShape {
  std::vector<glm::vec3> positions;  ///< [vertex_count], mesh units
  std::vector<glm::vec3> normals;    ///< [vertex_count] of any length, or empty: computed from the triangles
};

/// A shape placed in the scene: world axes, millimetres, unit normals that point outward.
struct PlacedShape {
  std::vector<glm::vec3> positions_mm;  ///< [vertex_count]
  std::vector<glm::vec3> normals;       ///< [vertex_count], or empty while nobody has asked for them
  bool flipped = false;                 ///< the transform mirrors: triangles run clockwise
};

struct Bounds {
  glm::vec3 lowest{0};
  glm::vec3 highest{0};
};

/// Applies `scene_from_mesh`, then `millimetres_per_unit`, to the positions (at least one) and gives their bounds;
/// leaves `placed` without normals. Spread over all cores, as are the others; the same bytes on any number of them.
Bounds place_positions(const MeshShape& shape, const glm::mat4& scene_from_mesh, double millimetres_per_unit,
                       PlacedShape& placed);

/// Gives `placed` its normals: those of `shape` turned; computed ones where it has none, or one of no length. `scratch`
/// keeps memory from call to call.
void place_normals(const MeshTopology& topology, const MeshShape& shape, const glm::mat4& scene_from_mesh,
                   PlacedShape& placed, std::vector<glm::vec3>& scratch);

/// Area-weighted unit normals, equal at all vertices of a weld. A weld with no area gets +z.
std::vector<glm::vec3> compute_normals(const MeshTopology& topology, std::span<const glm::vec3> positions);

/// Axis-aligned bounds of at least one position.
Bounds bounds_of(std::span<const glm::vec3> positions);

}  // namespace diaphane::geometry

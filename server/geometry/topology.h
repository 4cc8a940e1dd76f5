// What a mesh is made of, without where it is: triangles, and which vertices are the same place.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// Immutable, shared by every shape that the mesh takes as it deforms. Thread-safe (const after build).
///
/// Vertices at bit-equal uploaded positions are one *weld*: topology (adjacency, area, smooth normals) is counted in
/// welds, while shading keeps the vertices apart, so that hard edges given by normals stay hard.
struct MeshTopology {
  uint32_t vertex_count = 0;
  uint32_t weld_count = 0;
  std::vector<glm::uvec3> triangles;          ///< vertex indices, counter-clockwise seen from outside
  std::vector<glm::vec3> uploaded_positions;  ///< [vertex_count], mesh units; the rest pose
  std::vector<uint32_t> weld_of_vertex;       ///< [vertex_count] → 0..weld_count-1
  std::vector<uint32_t> first_triangle;       ///< [weld_count + 1] into triangle_of_weld
  std::vector<uint32_t> triangle_of_weld;     ///< triangles that touch each weld, ascending
  /// Every edge has two triangles that run it in opposite directions, and the rest pose has its inside behind them:
  /// from outside, triangles that face away are hidden.
  bool encloses_volume = false;
};

/// Checks and indexes a mesh. Errors: INVALID_ARGUMENT when there is no triangle, an index is past the last vertex, or
/// a position is not finite. Degenerate triangles are kept (they have no area).
absl::StatusOr<std::shared_ptr<const MeshTopology>> build_topology(std::vector<glm::vec3> positions,
                                                                   std::vector<glm::uvec3> triangles);

/// OK, or INVALID_ARGUMENT naming `field` and the first value that is NaN, infinite or beyond ±1e18.
absl::Status check_finite(std::span<const glm::vec3> values, std::string_view field);

}  // namespace diaphane::geometry

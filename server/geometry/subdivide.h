// Coarse triangles split on load, so that light that spreads less than their size is still resolved.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "geometry/topology.h"
#include "glm/vec2.hpp"
#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// Spacings h in mm: an edge longer than 1.2 h is halved. h is half the distance to the nearest crease (an edge that
/// bends by more than 30°, or has not two triangles), within these bounds.
struct SubdivisionOptions {
  float smallest_spacing_mm = 0.5f;
  float largest_spacing_mm = 2;
  /// Never more vertices than this: the spacings double until it holds. 0: the larger of 500,000 and four times the
  /// mesh.
  uint32_t max_vertices = 0;
};

/// A mesh whose first vertices are the original's; each further one is half way between two vertices before it.
struct SubdividedMesh {
  std::shared_ptr<const MeshTopology> topology;  ///< the original itself where no edge is long
  std::vector<glm::uvec2> parents;               ///< of vertex original count + i
};

/// Splits every long edge, the same on all its sides, until none is left: no T-junctions. `positions_mm` [vertex_count]
/// are the rest pose in mm, finite within ±1e15. Thread-safe.
absl::StatusOr<SubdividedMesh> subdivide(std::shared_ptr<const MeshTopology> mesh,
                                         std::span<const glm::vec3> positions_mm, const SubdivisionOptions& options);

/// Appends the positions of the further vertices to the original's, in any pose.
void extend_positions(std::span<const glm::uvec2> parents, std::vector<glm::vec3>& positions);

/// Appends unit normals: the renormalised sum of the parents', or the first parent's where that vanishes.
void extend_normals(std::span<const glm::uvec2> parents, std::vector<glm::vec3>& normals);

}  // namespace diaphane::geometry

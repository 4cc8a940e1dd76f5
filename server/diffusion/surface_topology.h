// The order in which the integral keeps a mesh: once per topology, before any light or pose is known.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/topology.h"
#include "glm/vec3.hpp"

namespace diaphane::diffusion {

/// Slots are the welds of a mesh in kd order: every aligned run of 4^k slots is a compact piece of the rest pose, so
/// the 4-ary tree over them is implicit. Depends on the uploaded positions alone. Immutable; thread-safe.
struct SurfaceTopology {
  std::shared_ptr<const geometry::MeshTopology> mesh;
  uint32_t slot_count = 0;
  std::vector<uint32_t> vertex_of_slot;  ///< [slot_count] the weld's first vertex: it says where the weld is
  std::vector<uint32_t> slot_of_vertex;  ///< [vertex_count]
  std::vector<uint32_t> twins;           ///< vertices that are not their weld's first, ascending

  /// The mesh's triangles (vertex indices), by smallest slot: the order in which irradiance is given.
  std::vector<glm::uvec3> triangles;
  std::vector<uint32_t> first_corner;        ///< [slot_count + 1] into triangle_of_corner
  std::vector<uint32_t> triangle_of_corner;  ///< into `triangles`, ascending for each slot
};

/// Orders `mesh`. About 0.3 µs a vertex. Thread-safe.
std::shared_ptr<const SurfaceTopology> build_surface_topology(std::shared_ptr<const geometry::MeshTopology> mesh);

/// A mesh whose vertices lie in the order of their slots, twins next to each other, and its triangles in the surface's:
/// what is near in space is near in memory.
struct OrderedSurface {
  std::shared_ptr<const SurfaceTopology> surface;
  std::vector<uint32_t> source_of_vertex;  ///< which vertex of the mesh before each one was
};

/// Lays the mesh of `surface` out anew. Thread-safe.
OrderedSurface lay_out(const SurfaceTopology& surface);

}  // namespace diaphane::diffusion

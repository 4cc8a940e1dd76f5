// Bytes that a mesh takes, from its counts alone.
#pragma once

#include <cstdint>

#include "glm/vec2.hpp"
#include "glm/vec3.hpp"
#include "scene/scene_store.h"

namespace diaphane::scene {

/// Of a geometry::MeshShape.
constexpr uint64_t shape_bytes(const MeshCounts& counts) {
  return sizeof(glm::vec3) * uint64_t{counts.vertex_count} * (counts.has_normals ? 2 : 1);
}

/// Of a geometry::MeshTopology: uploaded positions and two 32-bit figures a vertex; triangles and their list by weld.
constexpr uint64_t topology_bytes(const MeshCounts& counts) {
  return (sizeof(glm::vec3) + 8) * uint64_t{counts.vertex_count} + 24 * uint64_t{counts.triangle_count} + 4;
}

/// Of a geometry::SurfaceAttributes.
constexpr uint64_t attribute_bytes(const MeshCounts& counts) {
  return ((counts.has_texture_coordinates ? sizeof(glm::vec2) : 0) + (counts.has_colors ? sizeof(glm::vec3) : 0)) *
         uint64_t{counts.vertex_count};
}

/// Of geometry::MorphTargets.
constexpr uint64_t morph_bytes(const MeshCounts& counts) {
  return sizeof(glm::vec3) * uint64_t{counts.vertex_count} * counts.morph_target_count;
}

/// Of an upload's payload.
constexpr uint64_t payload_bytes(const MeshCounts& counts) {
  return shape_bytes(counts) + attribute_bytes(counts) + morph_bytes(counts) +
         sizeof(glm::uvec3) * uint64_t{counts.triangle_count};
}

/// At most, while a mesh is uploaded: the payload, what comes of it, and the hash table that finds the welds (16 bytes
/// and a control byte an entry, of which 7/8 to 7/16 are used) with its index.
constexpr uint64_t upload_bytes(const MeshCounts& counts) {
  return payload_bytes(counts) + shape_bytes(counts) + attribute_bytes(counts) + morph_bytes(counts) +
         topology_bytes(counts) + 44 * uint64_t{counts.vertex_count};
}

/// At most, while new positions are uploaded.
constexpr uint64_t positions_upload_bytes(const MeshCounts& counts) { return 2 * shape_bytes(counts); }

}  // namespace diaphane::scene

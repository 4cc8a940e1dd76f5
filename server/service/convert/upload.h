// Headers and payloads of the two upload streams.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "geometry/morph.h"
#include "geometry/surface_attributes.h"
#include "glm/vec3.hpp"
#include "scene/scene_store.h"

namespace diaphane::service {

/// What a header says of its payload.
struct PayloadSpec {
  scene::MeshCounts counts;  ///< no triangles: positions alone
  uint64_t total_bytes = 0;  ///< what the counts need
  std::string sha256;        ///< 32 bytes
};

/// Checks the counts against each other, not against limits.
absl::StatusOr<PayloadSpec> from_proto(const v1::MeshHeader& message);
absl::StatusOr<PayloadSpec> from_proto(const v1::PositionsHeader& message);

/// A payload's arrays.
struct PayloadArrays {
  std::vector<glm::vec3> positions;  ///< [vertex_count]
  std::vector<glm::vec3> normals;    ///< [vertex_count] or empty
  geometry::SurfaceAttributes attributes;
  std::vector<glm::uvec3> triangles;  ///< [triangle_count]
  geometry::MorphTargets morph_targets;
};

/// Of one mesh.
inline constexpr uint32_t kMaxMorphTargets = 256;

/// `bytes` are `spec.total_bytes`. INVALID_ARGUMENT for a position or normal that is not finite, or an
/// attribute that is out of range.
absl::StatusOr<PayloadArrays> read_arrays(const PayloadSpec& spec, std::span<const char> bytes);

}  // namespace diaphane::service

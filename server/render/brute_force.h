// Technique `reference`: the dipole by brute force at every pixel.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "glm/vec4.hpp"
#include "render/placed_mesh.h"
#include "render/shadow.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// One mesh and the light on it.
struct BruteForceBody {
  const geometry::MeshTopology& topology;
  const geometry::PlacedShape& shape;
  const optics::Coefficients& material;
  std::span<const LightStorage> lights;
  const ShadowScene* shadows;  ///< null: unshadowed
};

/// L = Ft·B/π (paper Eq. 2), linear RGB, at each of `positions_mm` with `normals`, seen from `eye_mm`; B sums all
/// surfels of the body, four a triangle. Spread over all cores. Errors: CANCELLED once `cancelled` is seen set.
absl::StatusOr<std::vector<glm::vec3>> brute_force_radiance(const BruteForceBody& body,
                                                            std::span<const glm::vec3> positions_mm,
                                                            std::span<const glm::vec3> normals, const glm::vec3& eye_mm,
                                                            const std::atomic<bool>& cancelled);

}  // namespace diaphane::render

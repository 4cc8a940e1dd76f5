// Technique `reference`: the surface integral by brute force at every pixel.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "glm/vec4.hpp"
#include "render/ambient.h"
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
  const Ambient& ambient;
  const ShadowScene* shadows;    ///< null: unshadowed
  const ShadowScene* occluders;  ///< null: nothing hides what is around
  bool slab_correction = false;
};

/// B, linear RGB, W·mm⁻², at each of `positions_mm` with `normals`: the sum over surfels at most half a mean free path
/// apart (or a cap); see diffusion::reference_kernel(). `progress`, if any, is told the share done, 0..1, growing, by
/// one thread at a time. Spread over all cores. Errors: CANCELLED once `cancelled` is seen set.
absl::StatusOr<std::vector<glm::vec3>> brute_force_radiosity(const BruteForceBody& body,
                                                             std::span<const glm::vec3> positions_mm,
                                                             std::span<const glm::vec3> normals,
                                                             const std::atomic<bool>& cancelled,
                                                             std::function<void(double)> progress = {});

/// E, linear RGB, W·mm⁻², at each of `positions_mm` with `normals`. Spread over all cores.
std::vector<glm::vec3> brute_force_irradiance(const BruteForceBody& body, std::span<const glm::vec3> positions_mm,
                                              std::span<const glm::vec3> normals);

/// L = Ft·B/π (paper Eq. 2), seen from `eye_mm`.
glm::vec3 leaving_radiance(const glm::vec3& radiosity, float refractive_index, const glm::vec3& position_mm,
                           const glm::vec3& normal, const glm::vec3& eye_mm);

}  // namespace diaphane::render

#include "render/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diffusion/reference.h"
#include "glm/geometric.hpp"
#include "render/lights.h"

namespace diaphane::render {

absl::StatusOr<std::vector<glm::vec3>> brute_force_radiance(const BruteForceBody& body,
                                                            std::span<const glm::vec3> positions_mm,
                                                            std::span<const glm::vec3> normals, const glm::vec3& eye_mm,
                                                            const std::atomic<bool>& cancelled) {
  const float refractive_index = body.material.refractive_index;
  const diffusion::IrradianceAt irradiance = [&](const glm::vec3& position, const glm::vec3& normal) {
    glm::vec3 e(0);
    for (const LightStorage& light : body.lights) {
      const glm::vec3 entering = entering_irradiance(light, position, normal, refractive_index);
      if (entering == glm::vec3(0)) continue;
      e += (body.shadows == nullptr ? 1.0f : body.shadows->visibility_at(light, position, normal)) * entering;
    }
    return e;
  };
  const optics::Dipole dipole = optics::make_dipole(body.material);
  const glm::vec3& l = dipole.mean_free_path_mm;
  const diffusion::SurfelOptions sampling{.splits = 1, .spacing_mm = 0.5f * std::min({l.x, l.y, l.z})};
  const diffusion::Surfels surfels = diffusion::sample_surface(body.topology.triangles, body.shape.positions_mm,
                                                               body.shape.normals, irradiance, sampling);
  diffusion::ReferenceOptions options;
  options.cancelled = &cancelled;
  absl::StatusOr<std::vector<glm::vec3>> radiosity =
      diffusion::reference_radiosity(dipole, surfels, positions_mm, options);
  if (!radiosity.ok()) return radiosity;
  for (size_t i = 0; i < radiosity->size(); ++i) {
    const float cosine = std::abs(glm::dot(normals[i], glm::normalize(eye_mm - positions_mm[i])));
    (*radiosity)[i] *= optics::fresnel_transmittance(refractive_index, cosine) / std::numbers::pi_v<float>;
  }
  return radiosity;
}

}  // namespace diaphane::render

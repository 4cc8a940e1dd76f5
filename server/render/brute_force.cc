#include "render/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "diffusion/reference.h"
#include "glm/geometric.hpp"
#include "render/ambient_occlusion.h"
#include "render/lights.h"
#include "render/slab_correction.h"
#include "render/thickness.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {

namespace {

/// Directions from which light is looked for around a point.
constexpr uint32_t kOcclusionRays = 192;

diffusion::IrradianceAt irradiance_on(const BruteForceBody& body) {
  const AmbientIrradiance around = ambient_irradiance(body.ambient, body.material.refractive_index);
  AmbientDirections directions;
  if (body.occluders != nullptr && body.ambient.light != nullptr) {
    directions = ambient_directions(body.ambient, body.material.refractive_index, kOcclusionRays);
  }
  return [&body, around, directions = std::move(directions)](const glm::vec3& position, const glm::vec3& normal) {
    glm::vec3 e = around.at(normal);
    if (!directions.towards.empty()) {
      e *= directions.share(normal, [&](size_t k) {
        const LightStorage from{.position_mm = glm::vec4(directions.towards[k], 0), .power = glm::vec4(0, 0, 0, 1)};
        return body.occluders->visibility_at(from, position, normal);
      });
    }
    for (const LightStorage& light : body.lights) {
      const glm::vec3 entering = entering_irradiance(light, position, normal, body.material.refractive_index);
      if (entering == glm::vec3(0)) continue;
      e += (body.shadows == nullptr ? 1.0f : body.shadows->visibility_at(light, position, normal)) * entering;
    }
    return e;
  };
}

absl::StatusOr<std::vector<glm::vec3>> uncorrected_radiosity(const BruteForceBody& body,
                                                             std::span<const glm::vec3> positions_mm,
                                                             std::span<const glm::vec3> normals,
                                                             const std::atomic<bool>& cancelled,
                                                             std::function<void(double)> progress) {
  const diffusion::ReferenceKernel kernel = diffusion::reference_kernel(optics::make_profile(body.material));
  const diffusion::SurfelOptions sampling{.splits = 1, .spacing_mm = kernel.spacing_mm};
  const diffusion::Surfels surfels = diffusion::sample_surface(body.topology.triangles, body.shape.positions_mm,
                                                               body.shape.normals, irradiance_on(body), sampling);
  diffusion::ReferenceOptions options;
  options.cancelled = &cancelled;
  options.progress = std::move(progress);
  auto radiosity = diffusion::reference_radiosity(kernel.spread, surfels, positions_mm, options);
  if (!radiosity.ok() || kernel.local == glm::vec3(0)) return radiosity;
  const std::vector<glm::vec3> irradiance = brute_force_irradiance(body, positions_mm, normals);
  for (size_t i = 0; i < irradiance.size(); ++i) (*radiosity)[i] += kernel.local * irradiance[i];
  return radiosity;
}

}  // namespace

absl::StatusOr<std::vector<glm::vec3>> brute_force_radiosity(const BruteForceBody& body,
                                                             std::span<const glm::vec3> positions_mm,
                                                             std::span<const glm::vec3> normals,
                                                             const std::atomic<bool>& cancelled,
                                                             std::function<void(double)> progress) {
  if (!body.slab_correction) {
    return uncorrected_radiosity(body, positions_mm, normals, cancelled, std::move(progress));
  }
  ThicknessField thickness;
  thickness.update(body.topology.triangles, body.shape);
  const std::vector<OppositePoint> opposites = thickness.find(positions_mm, normals);
  // Behind the points, those on the other side.
  std::vector<glm::vec3> receivers(positions_mm.begin(), positions_mm.end());
  std::vector<glm::vec3> receiver_normals(normals.begin(), normals.end());
  for (const OppositePoint& opposite : opposites) {
    receivers.push_back(opposite.of(body.topology.triangles, body.shape.positions_mm));
    const glm::vec3 sum = opposite.of(body.topology.triangles, body.shape.normals);
    const float length = glm::length(sum);
    receiver_normals.push_back(length > 0 ? sum / length : glm::vec3(0, 0, 1));
  }
  auto radiosity = uncorrected_radiosity(body, receivers, receiver_normals, cancelled, std::move(progress));
  if (!radiosity.ok()) return radiosity;
  const SlabGains gains(body.material);
  constexpr size_t kRays = ThicknessField::kRays;
  const auto there = std::span<const glm::vec3>(*radiosity).subspan(positions_mm.size());
  std::vector<glm::vec3> corrected;
  for (size_t i = 0; i < positions_mm.size(); ++i) {
    corrected.push_back(slab_corrected(gains, std::span(opposites).subspan(kRays * i, kRays), (*radiosity)[i],
                                       there.subspan(kRays * i, kRays)));
  }
  return corrected;
}

std::vector<glm::vec3> brute_force_irradiance(const BruteForceBody& body, std::span<const glm::vec3> positions_mm,
                                              std::span<const glm::vec3> normals) {
  const diffusion::IrradianceAt irradiance = irradiance_on(body);
  std::vector<glm::vec3> e(positions_mm.size());
  tbb::parallel_for(size_t{0}, e.size(), [&](size_t i) { e[i] = irradiance(positions_mm[i], normals[i]); });
  return e;
}

glm::vec3 leaving_radiance(const glm::vec3& radiosity, float refractive_index, const glm::vec3& position_mm,
                           const glm::vec3& normal, const glm::vec3& eye_mm) {
  const float cosine = std::abs(glm::dot(normal, glm::normalize(eye_mm - position_mm)));
  return radiosity * (optics::fresnel_transmittance(refractive_index, cosine) / std::numbers::pi_v<float>);
}

}  // namespace diaphane::render

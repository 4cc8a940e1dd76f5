#include "tests/support/lighting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "optics/dipole.h"

namespace diaphane::testing {

diffusion::IrradianceAt irradiance_of(std::vector<PointLight> lights, float refractive_index) {
  return [lights = std::move(lights), refractive_index](const glm::vec3& position_mm, const glm::vec3& normal) {
    glm::vec3 sum(0);
    for (const PointLight& light : lights) {
      const glm::vec3 way = light.position_mm - position_mm;
      const float distance2 = glm::dot(way, way);
      const float cosine = std::max(0.0f, glm::dot(normal, way) / std::sqrt(distance2));
      sum += light.intensity_w_sr * (optics::fresnel_transmittance(refractive_index, cosine) * cosine / distance2);
    }
    return sum;
  };
}

diffusion::IrradianceAt irradiance_of(optics::EnvironmentLight light, float refractive_index) {
  const optics::Harmonics around = optics::irradiance_harmonics(light.radiance, refractive_index);
  return [light = std::move(light), around, refractive_index](const glm::vec3&, const glm::vec3& normal) {
    glm::vec3 sum = glm::max(optics::evaluate(around, normal), glm::vec3(0));
    for (const optics::EnvironmentLamp& lamp : light.lamps) {
      const float cosine = std::max(0.0f, -glm::dot(normal, lamp.direction));
      sum += cosine * optics::fresnel_transmittance(refractive_index, cosine) * lamp.irradiance;
    }
    return sum;
  };
}

SurfaceIrradiance light_surface(const diffusion::SurfaceTopology& topology, std::span<const glm::vec3> positions_mm,
                                std::span<const glm::vec3> normals, const diffusion::IrradianceAt& irradiance) {
  SurfaceIrradiance light;
  for (const glm::uvec3& t : topology.triangles) {
    const glm::vec3 normal = normals[t.x] + normals[t.y] + normals[t.z];
    const float length = glm::length(normal);
    light.at_triangles.push_back(
        length > 0 ? irradiance((positions_mm[t.x] + positions_mm[t.y] + positions_mm[t.z]) / 3.0f, normal / length)
                   : glm::vec3(0));
  }
  for (size_t v = 0; v < positions_mm.size(); ++v) light.at_vertices.push_back(irradiance(positions_mm[v], normals[v]));
  return light;
}

}  // namespace diaphane::testing

#include "render/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"
#include "optics/dipole.h"
#include "render/ambient.h"

namespace diaphane::render {
namespace {

LightStorage key_light(const geometry::Bounds& bounds_mm) {
  const glm::vec3 centre = 0.5f * (bounds_mm.lowest + bounds_mm.highest);
  const float radius = std::max(0.5f * glm::distance(bounds_mm.lowest, bounds_mm.highest), 1e-6f);
  const float distance = 2.5f * radius;
  const glm::vec3 direction = glm::normalize(glm::vec3(-0.6f, 0.8f, 0.9f));
  LightStorage light;
  light.position_mm = glm::vec4(centre + distance * direction, 0);
  light.power = glm::vec4(glm::vec3(2 * distance * distance), 0);
  return light;
}

LightStorage storage_of(const scene::PointLight& point, float millimetres_per_unit) {
  LightStorage light;
  light.position_mm = glm::vec4(point.position * millimetres_per_unit, 0);
  light.power = glm::vec4(point.intensity_w_sr, 0);
  light.shape.y = point.radius_mm;
  return light;
}

LightStorage storage_of(const scene::DirectionalLight& directional, float) {
  LightStorage light;
  light.position_mm = glm::vec4(-glm::normalize(directional.direction), 0);
  light.power = glm::vec4(directional.irradiance, 1);
  return light;
}

LightStorage storage_of(const scene::SpotLight& spot, float millimetres_per_unit) {
  LightStorage light = storage_of(spot.point, millimetres_per_unit);
  const float inner = std::cos(glm::radians(spot.inner_angle_deg));
  const float outer = std::cos(glm::radians(spot.outer_angle_deg));
  light.axis = glm::vec4(glm::normalize(spot.direction), outer);
  light.shape.x = 1 / std::max(inner - outer, 1e-6f);
  return light;
}

}  // namespace

void list_lights(const scene::SceneSnapshot& scene, const geometry::Bounds& bounds_mm,
                 std::vector<LightStorage>& lights) {
  lights.clear();
  if (scene.lights.empty() && scene.environment == nullptr) lights.push_back(key_light(bounds_mm));
  const auto scale = static_cast<float>(scene.millimetres_per_unit);
  for (const scene::Light& light : scene.lights) {
    lights.push_back(std::visit([&](const auto& kind) { return storage_of(kind, scale); }, light.kind));
  }
  if (scene.environment == nullptr) return;
  const scene::Environment& environment = *scene.environment;
  for (const optics::EnvironmentLamp& lamp : environment.light->lamps) {
    lights.push_back(storage_of(scene::DirectionalLight{rotated_about_y(lamp.direction, environment.rotation_deg),
                                                        environment.intensity * lamp.irradiance},
                                scale));
  }
}

ArrivingLight arriving_light(const LightStorage& light, const glm::vec3& position_mm) {
  const glm::vec3 power(light.power);
  if (light.power.a != 0) return {glm::vec3(light.position_mm), power, std::numeric_limits<float>::infinity()};
  const glm::vec3 to_light = glm::vec3(light.position_mm) - position_mm;
  const float squared = std::max(glm::dot(to_light, to_light), 1e-12f);
  const float distance = std::sqrt(squared);
  const glm::vec3 towards = to_light / distance;
  const float cone = std::clamp((-glm::dot(towards, glm::vec3(light.axis)) - light.axis.a) * light.shape.x, 0.0f, 1.0f);
  const float share = light.axis.a < -1 ? 1.0f : cone * cone * (3 - 2 * cone);
  return {towards, power * (share / squared), distance};
}

glm::vec3 entering_irradiance(const LightStorage& light, const glm::vec3& position_mm, const glm::vec3& normal,
                              float refractive_index) {
  const ArrivingLight arriving = arriving_light(light, position_mm);
  const float cosine = glm::dot(normal, arriving.towards);
  if (cosine <= 0) return glm::vec3(0);
  return arriving.irradiance * (cosine * optics::fresnel_transmittance(refractive_index, cosine));
}

}  // namespace diaphane::render

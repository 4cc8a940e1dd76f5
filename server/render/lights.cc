#include "render/lights.h"

#include <algorithm>

#include "glm/geometric.hpp"

namespace diaphane::render {
namespace {

PointLightStorage key_light(const geometry::Bounds& bounds_mm) {
  const glm::vec3 centre = 0.5f * (bounds_mm.lowest + bounds_mm.highest);
  const float radius = std::max(0.5f * glm::distance(bounds_mm.lowest, bounds_mm.highest), 1e-6f);
  const float distance = 2.5f * radius;
  const glm::vec3 direction = glm::normalize(glm::vec3(-0.6f, 0.8f, 0.9f));
  return {glm::vec4(centre + distance * direction, 0), glm::vec4(glm::vec3(2 * distance * distance), 0)};
}

}  // namespace

std::vector<PointLightStorage> lights_of(const scene::SceneSnapshot& scene, const geometry::Bounds& bounds_mm) {
  if (scene.lights.empty()) return {key_light(bounds_mm)};
  std::vector<PointLightStorage> lights;
  lights.reserve(scene.lights.size());
  for (const scene::Light& light : scene.lights) {
    const auto& point = std::get<scene::PointLight>(light.kind);
    lights.push_back({glm::vec4(point.position * static_cast<float>(scene.millimetres_per_unit), 0),
                      glm::vec4(point.intensity_w_sr, 0)});
  }
  return lights;
}

}  // namespace diaphane::render

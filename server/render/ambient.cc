#include "render/ambient.h"

#include <cmath>

#include "glm/common.hpp"
#include "glm/trigonometric.hpp"

namespace diaphane::render {

Ambient ambient_of(const scene::SceneSnapshot& scene) {
  if (scene.environment == nullptr) return {};
  return {scene.environment->light, scene.environment->rotation_deg, scene.environment->intensity,
          scene.environment->occlusion};
}

glm::vec3 AmbientIrradiance::at(const glm::vec3& normal) const {
  const glm::vec3 of_map(cosine * normal.x - sine * normal.z, normal.y, sine * normal.x + cosine * normal.z);
  // Harmonics that end somewhere may ring below nothing.
  return glm::max(optics::evaluate(harmonics, of_map), glm::vec3(0));
}

AmbientIrradiance ambient_irradiance(const Ambient& ambient, float refractive_index) {
  AmbientIrradiance irradiance;
  if (ambient.light == nullptr) return irradiance;
  irradiance.harmonics = optics::irradiance_harmonics(ambient.light->radiance, refractive_index);
  for (glm::vec3& harmonic : irradiance.harmonics) harmonic *= ambient.intensity;
  irradiance.cosine = std::cos(glm::radians(ambient.rotation_deg));
  irradiance.sine = std::sin(glm::radians(ambient.rotation_deg));
  return irradiance;
}

glm::vec3 rotated_about_y(const glm::vec3& direction, float rotation_deg) {
  const float cosine = std::cos(glm::radians(rotation_deg)), sine = std::sin(glm::radians(rotation_deg));
  return {cosine * direction.x + sine * direction.z, direction.y, cosine * direction.z - sine * direction.x};
}

}  // namespace diaphane::render

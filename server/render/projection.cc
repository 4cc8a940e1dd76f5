#include "render/projection.h"

#include <algorithm>

#include "glm/ext/matrix_clip_space.hpp"
#include "glm/ext/matrix_transform.hpp"
#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"

namespace diaphane::render {

glm::mat4 clip_from_world(const scene::Camera& camera, double millimetres_per_unit, float aspect,
                          const geometry::Bounds& bounds_mm) {
  const auto scale = static_cast<float>(millimetres_per_unit);
  const glm::vec3 eye_mm = camera.eye * scale;
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
  const glm::vec3 centre = 0.5f * (bounds_mm.lowest + bounds_mm.highest);
  const float radius = std::max(0.5f * glm::distance(bounds_mm.lowest, bounds_mm.highest), 1e-6f);
  const float along = glm::dot(centre - eye_mm, forward);
  const float far = std::max(along + 1.01f * radius, 1e-5f);
  const float near = std::max(along - 1.01f * radius, far * 1e-4f);
  const glm::mat4 view_from_world = glm::lookAt(eye_mm, eye_mm + forward, camera.up);
  return glm::perspective(glm::radians(camera.fov_y_deg), aspect, near, std::max(far, 1.001f * near)) * view_from_world;
}

}  // namespace diaphane::render

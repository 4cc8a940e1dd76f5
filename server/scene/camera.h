#pragma once

#include "glm/vec3.hpp"

namespace diaphane::scene {

/// A pinhole camera, right-handed, scene units.
struct Camera {
  glm::vec3 eye{0, 0, 1};
  glm::vec3 target{0};
  glm::vec3 up{0, 1, 0};
  float fov_y_deg = 30;  ///< full angle, 1..170
};

}  // namespace diaphane::scene

// What lies under a pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "glm/vec2.hpp"
#include "glm/vec3.hpp"
#include "scene/camera.h"
#include "scene/snapshot.h"

namespace diaphane::scene {

/// A point of a surface, seen from a camera.
struct Picked {
  std::string mesh;            ///< scenes/{scene}/meshes/{mesh}
  uint32_t triangle = 0;       ///< of those uploaded
  glm::vec3 barycentric{0};    ///< shares of the triangle's vertices in the point; they sum to 1
  glm::dvec3 position{0};      ///< scene units
  glm::dvec3 facet_normal{0};  ///< unit, turned to the eye, scene axes
  double distance = 0;         ///< from the eye, scene units
};

/// The nearest surface under `pixel` of a frame of `size_px`, from the frame's upper left corner: the first pixel's
/// centre is (0.5, 0.5). Front and back sides count. Nothing where the ray meets none. Takes time linear in the
/// triangles. Thread-safe.
std::optional<Picked> pick(const SceneSnapshot& scene, const Camera& camera, const glm::uvec2& size_px,
                           const glm::vec2& pixel);

}  // namespace diaphane::scene

#pragma once

#include "geometry/shape.h"
#include "glm/mat4x4.hpp"
#include "scene/camera.h"

namespace diaphane::render {

/// Clip space (OpenGL's, z in −1..1) from world millimetres. `camera` in scene units; near and far enclose `bounds_mm`.
glm::mat4 clip_from_world(const scene::Camera& camera, double millimetres_per_unit, float aspect,
                          const geometry::Bounds& bounds_mm);

}  // namespace diaphane::render

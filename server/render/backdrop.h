// A scene's environment behind its bodies.
#pragma once

#include "base/image.h"
#include "scene/camera.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Radiance that arrives from `direction` (unit, scene axes), W·mm⁻²·sr⁻¹: the map, lamps and all, between its pixels
/// bilinear, rotated and multiplied as the scene says.
glm::vec3 backdrop_radiance(const scene::Environment& environment, const glm::vec3& direction);

/// Lays `picture` (R G B A first, colour multiplied by alpha) over what `camera` sees of the environment; alpha becomes
/// 1. Every pixel that shows some of it looks in `samples` (1..64) places. Spread over all cores.
void lay_over_environment(const scene::Environment& environment, const scene::Camera& camera, uint32_t samples,
                          base::ImageF& picture);

}  // namespace diaphane::render

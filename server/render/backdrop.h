// A scene's environment behind its bodies.
#pragma once

#include "base/image.h"
#include "scene/camera.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Lays `picture` (R G B A first, colour multiplied by alpha) over what `camera` sees of the environment: the map,
/// lamps and all, rotated and multiplied as the scene says; alpha becomes 1. Every pixel that shows some of it looks in
/// `samples` (1..64) places. Spread over all cores.
void lay_over_environment(const scene::Environment& environment, const scene::Camera& camera, uint32_t samples,
                          base::ImageF& picture);

}  // namespace diaphane::render

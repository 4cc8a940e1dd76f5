// A scene's lights in millimetres, as the stages read them.
#pragma once

#include <vector>

#include "geometry/shape.h"
#include "render/uniforms.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// All lights of `scene`; where it has none, one key light for a body within `bounds_mm`: from above, left and in front
/// (+y, −x, +z) at 2.5 times the radius of the bounding sphere, with an unattenuated irradiance of 2 W·mm⁻² at its
/// centre.
std::vector<PointLightStorage> lights_of(const scene::SceneSnapshot& scene, const geometry::Bounds& bounds_mm);

}  // namespace diaphane::render

// A scene's lights in millimetres, and what arrives of them.
#pragma once

#include <vector>

#include "geometry/shape.h"
#include "render/uniforms.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Fills `lights` with all lights of `scene`, its environment's lamps after them; where it has neither, one key light
/// for a body within `bounds_mm`: from above, left and in front
/// (+y, −x, +z) at 2.5 times the radius of the bounding sphere, with an unattenuated irradiance of 2 W·mm⁻² at its
/// centre.
void list_lights(const scene::SceneSnapshot& scene, const geometry::Bounds& bounds_mm,
                 std::vector<LightStorage>& lights);

/// Light at a point before any surface is asked. shaders/shared/lights.glsl says the same.
struct ArrivingLight {
  glm::vec3 towards;     ///< unit, from the point to the light
  glm::vec3 irradiance;  ///< RGB, W·mm⁻², on a surface that faces the light
  float distance_mm;     ///< infinite for a directional light
};
ArrivingLight arriving_light(const LightStorage& light, const glm::vec3& position_mm);

/// The share E of one light that enters a body there, unshadowed: clamped cosine and Fresnel transmittance (paper Eq.
/// 4).
glm::vec3 entering_irradiance(const LightStorage& light, const glm::vec3& position_mm, const glm::vec3& normal,
                              float refractive_index);

}  // namespace diaphane::render

// Light from all around on a body.
#pragma once

#include <memory>

#include "optics/environment.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// What of a scene's environment is no lamp. Values; equal ones light alike.
struct Ambient {
  std::shared_ptr<const optics::EnvironmentLight> light;  ///< null: none
  float rotation_deg = 0;
  float intensity = 1;
  bool occluded = false;  ///< bodies hide it

  bool operator==(const Ambient&) const = default;
};

Ambient ambient_of(const scene::SceneSnapshot& scene);

/// E(N) of it, W·mm⁻², unshadowed, Fresnel of one body inside.
struct AmbientIrradiance {
  optics::Harmonics harmonics{};  ///< of the map as it was given
  float cosine = 1, sine = 0;     ///< of its rotation about +y

  glm::vec3 at(const glm::vec3& normal) const;
};

/// All zero where there is none. `refractive_index` 1: without Fresnel.
AmbientIrradiance ambient_irradiance(const Ambient& ambient, float refractive_index);

/// A direction of the map as it was given, in the scene.
glm::vec3 rotated_about_y(const glm::vec3& direction, float rotation_deg);

}  // namespace diaphane::render

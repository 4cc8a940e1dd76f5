// The uniform and storage blocks of shaders/shared, byte for byte.
#pragma once

#include <cstdint>

#include "glm/mat4x4.hpp"
#include "glm/vec4.hpp"
#include "optics/dipole.h"
#include "optics/profile.h"

namespace diaphane::render {

#include "../../shaders/shared/bindings.glsl"

struct ViewUniforms {
  glm::mat4 clip_from_world{1};
  glm::vec4 eye_mm{0};
  float radiance_scale = 1;
  float mesh_id = 0;
  float unused[2] = {};
};
static_assert(sizeof(ViewUniforms) == 96);

struct MaterialUniforms {
  glm::vec4 mean_free_path_mm;
  glm::vec4 virtual_height_mm;
  glm::vec4 effective_transport_mm;
  glm::vec4 reduced_albedo;
  glm::vec4 total_reflectance;
  glm::vec4 normal_map_scale{0};
};
static_assert(sizeof(MaterialUniforms) == 96);

struct BoxUniforms {
  glm::vec4 centre_mm{0};
  glm::vec4 extent_mm{1};
  int32_t face_size_px = 0;
  int32_t unused[3] = {};
};
static_assert(sizeof(BoxUniforms) == 48);

struct PaperUniforms {
  int32_t terms = 0;
  int32_t kernel_taps = 0;
  float global_gain = 1;
  float unused = 0;
};
static_assert(sizeof(PaperUniforms) == 16);

/// A light of any kind, in millimetres and world axes.
struct LightStorage {
  glm::vec4 position_mm{0};     ///< xyz; or the unit direction to a directional light
  glm::vec4 power{0};           ///< rgb: W·sr⁻¹, or W·mm⁻² of a directional light; a: 1 directional, else 0
  glm::vec4 axis{0, 0, 0, -2};  ///< xyz: unit axis of a spot's cone; a: cosine of its outer angle, −2 without a cone
  glm::vec4 shape{0};           ///< x: 1/(cosine inner − cosine outer); y: radius in mm; z: for one body's shading
                                ///< with shadows, the share of the light's power that reaches it
  bool operator==(const LightStorage&) const = default;
};
static_assert(sizeof(LightStorage) == 64);

/// The paper gives one mean free path: the kernel's width takes the mean of the three channels'.
inline MaterialUniforms material_uniforms(const optics::Coefficients& material, float normal_scale = 0) {
  const optics::Dipole dipole = optics::make_dipole(material);
  const glm::vec3& l = dipole.mean_free_path_mm;
  return {glm::vec4(l, material.refractive_index),           glm::vec4(dipole.virtual_height_mm, (l.x + l.y + l.z) / 3),
          glm::vec4(dipole.effective_transport_mm, 0),       glm::vec4(dipole.reduced_albedo, 0),
          glm::vec4(optics::total_reflectance(material), 0), glm::vec4(normal_scale, 0, 0, 0)};
}

}  // namespace diaphane::render

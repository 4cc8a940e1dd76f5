// What a scene is at one revision: immutable values that any thread may read and the render thread draws.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/morph.h"
#include "geometry/shape.h"
#include "geometry/surface_attributes.h"
#include "geometry/topology.h"
#include "glm/mat4x4.hpp"
#include "glm/vec3.hpp"
#include "optics/coat.h"
#include "optics/environment.h"
#include "optics/material.h"

namespace diaphane::scene {

/// The pixels of a texture: 8-bit RGBA, rows from the upper edge down.
struct TexturePixels {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<uint8_t> rgba;
};

/// How pixels are read.
struct TextureSampling {
  bool srgb = false;     ///< RGB is sRGB-coded; else linear
  bool clamp_u = false;  ///< beyond 0..1 the edge is held; else the picture repeats
  bool clamp_v = false;
  bool operator==(const TextureSampling&) const = default;
};

struct Texture {
  std::string name;  ///< scenes/{scene}/textures/{texture}
  std::shared_ptr<const TexturePixels> pixels;
  TextureSampling sampling;
};

/// Names of textures of the same scene; empty: none.
struct SurfaceTextures {
  std::string albedo;     ///< multiplies what leaves the body
  std::string normal;     ///< the coat's, tangent space
  std::string roughness;  ///< green multiplies the coat's
  float normal_scale = 1;
  bool any() const { return !albedo.empty() || !normal.empty() || !roughness.empty(); }
};

struct Material {
  std::string name;  ///< scenes/{scene}/materials/{material}
  optics::MaterialForm form;
  optics::Coefficients coefficients;    ///< what the form comes to, with the profile that was asked for
  std::vector<std::string> warnings{};  ///< what is doubtful about them, a sentence each
  std::optional<optics::Coat> coat{};   ///< not given: none
  SurfaceTextures textures{};
};

/// Shines in all directions; irradiance falls with the square of the distance in millimetres.
struct PointLight {
  glm::vec3 position{0};        ///< scene units
  glm::vec3 intensity_w_sr{0};  ///< W·sr⁻¹
  float radius_mm = 0;          ///< 0: hard shadows
};

/// Parallel light from far away.
struct DirectionalLight {
  glm::vec3 direction{0, -1, 0};  ///< in which the light travels; any length but none
  glm::vec3 irradiance{0};        ///< W·mm⁻² on a surface that faces it
};

/// A point light within a cone: full within the inner angle, none beyond the outer one, smooth between.
struct SpotLight {
  PointLight point;
  glm::vec3 direction{0, -1, 0};  ///< axis of the cone; any length but none
  float inner_angle_deg = 20;     ///< from the axis, 0..90, at most the outer one
  float outer_angle_deg = 30;     ///< from the axis, above 0, up to 90
};

using LightKind = std::variant<PointLight, DirectionalLight, SpotLight>;

struct Light {
  std::string name;  ///< scenes/{scene}/lights/{light}
  LightKind kind;
};

/// Light from all around.
struct Environment {
  std::string name;                                       ///< scenes/{scene}/environment
  std::shared_ptr<const optics::LatLongMap> map;          ///< as it was given
  std::shared_ptr<const optics::EnvironmentLight> light;  ///< what it is to bodies
  float rotation_deg = 0;                                 ///< about +y, counter-clockwise seen from above
  float intensity = 1;                                    ///< multiplies both
  bool occlusion = false;                                 ///< bodies hide what of it is no lamp
};

struct Mesh {
  std::string name;  ///< scenes/{scene}/meshes/{mesh}
  std::string material;
  glm::mat4 scene_from_mesh{1};
  std::shared_ptr<const geometry::MeshTopology> topology;           ///< the same object as long as the triangles are
  std::shared_ptr<const geometry::MeshShape> shape;                 ///< a new object whenever positions change
  uint64_t positions_revision = 0;                                  ///< scene revision at which `shape` last changed
  std::shared_ptr<const geometry::SurfaceAttributes> attributes{};  ///< null: none
  std::shared_ptr<const geometry::MorphTargets> morph_targets{};    ///< null: none
};

/// Stages compare the shared pointers and values in here to learn what changed; there is nothing else to compare.
struct SceneSnapshot {
  std::string name;  ///< scenes/{scene}
  std::string display_name;
  uint64_t revision = 0;
  double millimetres_per_unit = 1;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::shared_ptr<const Environment> environment;  ///< null: none
};

/// What `mesh` is made of; null where the scene has no such material.
inline const Material* material_of(const SceneSnapshot& scene, const Mesh& mesh) {
  for (const Material& material : scene.materials) {
    if (material.name == mesh.material) return &material;
  }
  return nullptr;
}

/// The texture of that name; null where the scene has none.
inline const Texture* texture_of(const SceneSnapshot& scene, const std::string& name) {
  for (const Texture& texture : scene.textures) {
    if (texture.name == name) return &texture;
  }
  return nullptr;
}

}  // namespace diaphane::scene

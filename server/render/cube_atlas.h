// The paper's cube map: irradiance and surface of a mesh, seen from the six faces of its box.
#pragma once

#include <vector>

#include "absl/functional/function_ref.h"
#include "geometry/shape.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// The box of `bounds`, padded so that no extent is nothing.
BoxUniforms fit_box(const geometry::Bounds& bounds_mm, uint32_t face_size_px);

/// Everything that the atlas's texels are made of. Equal keys make equal texels.
struct AtlasKey {
  uint64_t mesh_generation = 0;
  std::vector<LightStorage> lights;
  float refractive_index = 1;
  uint32_t face_size_px = 0;
  uint64_t irradiance_generation = 0;  ///< of E with shadows at the vertices; 0: E is the shader's
  bool operator==(const AtlasKey&) const = default;
};

/// Two array textures of six layers, rows bottom to top; see shaders/atlas.frag for what their channels hold.
/// Render thread only.
class CubeAtlas {
 public:
  CubeAtlas(AtlasKey key, const BoxUniforms& box);
  /// Stands for other texels of as many from now on, which render() is to make.
  void renew(const AtlasKey& key, const BoxUniforms& box) {
    key_ = key;
    box_ = box;
  }

  /// Pass 1: `draw_mesh` six times with `program` (atlas.vert + atlas.frag), MaterialUniforms, BoxUniforms and the
  /// lights bound; it is told where the projection turns left into right.
  void render(const gl::Program& program, absl::FunctionRef<void(bool mirrored)> draw_mesh);

  const AtlasKey& key() const { return key_; }
  const BoxUniforms& box() const { return box_; }
  const gl::Texture& irradiance() const { return irradiance_; }
  const gl::Texture& surface() const { return surface_; }
  size_t bytes() const;

 private:
  AtlasKey key_;
  BoxUniforms box_;
  gl::Texture irradiance_;
  gl::Texture surface_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
};

}  // namespace diaphane::render

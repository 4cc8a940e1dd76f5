// Pictures of a mesh made in process, and what each of their pixels sees of it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "render/frame.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"
#include "tests/support/rays.h"

namespace diaphane::testing {

/// A square picture, scene units mm.
struct View {
  scene::Camera camera;
  uint32_t size_px = 128;
};

/// A view of everything within `radius_mm` of the origin, from `direction` (any length) of it.
View view_from(const glm::vec3& direction, float radius_mm, uint32_t size_px);

/// What the ray through a pixel's centre meets first.
struct Sight {
  glm::vec3 position_mm;
  glm::vec3 normal;  ///< interpolated, unit
  float cosine;      ///< |normal · way to the eye|
};

/// A view's pixels, rows top to bottom.
struct Sights {
  std::vector<std::optional<Sight>> of_pixel;
  uint32_t size_px;
  float pixel_mm;  ///< width of a pixel at the distance of the origin

  /// The pixel and its eight neighbours all see the mesh, and nowhere between them does the surface jump.
  bool is_inside(size_t pixel) const;
};
Sights trace(const Mesh& mesh, const MeshRays& rays, const View& view);

/// A scene of one mesh in mm, called the same every time: its light is kept from frame to frame where it may be.
std::shared_ptr<scene::SceneSnapshot> make_scene(const Mesh& mesh, const optics::Coefficients& material,
                                                 std::span<const PointLight> lights);
/// The scene with the mesh in another pose.
std::shared_ptr<scene::SceneSnapshot> with_pose(const scene::SceneSnapshot& scene, const Mesh& pose);

/// A request for outgoing radiance in float; without shadows, so that techniques may be compared.
render::FrameRequest unshadowed_request(std::shared_ptr<const scene::SceneSnapshot> scene, const View& view,
                                        render::Technique technique,
                                        diffusion::Quality quality = diffusion::Quality::kFine);

/// Outgoing radiance, W·mm⁻²·sr⁻¹, rows top to bottom, 0 where nothing is. Throws std::runtime_error on errors.
std::vector<glm::vec3> radiance_of(render::FrameRenderer& renderer, const render::FrameRequest& request);

}  // namespace diaphane::testing

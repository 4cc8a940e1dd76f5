// What a light outside a scene sees of it: a depth map, rasterised natively.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "render/uniforms.h"
#include "tbb/enumerable_thread_specific.h"

namespace diaphane::render {

/// A mesh that casts shadows, by reference.
struct ShadowCaster {
  std::span<const glm::uvec3> triangles;
  std::span<const glm::vec3> positions_mm;
  bool encloses_volume = false;  ///< triangles that face away from a light outside are never the nearest
  bool flipped = false;          ///< triangles run clockwise seen from outside
};

/// One light's view of all casters, fitted to them. Work is spread over all cores; the same bytes on any number of
/// them.
class ShadowMap {
 public:
  /// Whether a map can show what `light` sees of a scene within `bounds_mm`: it has no radius, and is directional or
  /// well outside.
  static bool serves(const LightStorage& light, const geometry::Bounds& bounds_mm);

  /// Draws the casters. One thread calls; memory is kept from call to call.
  void draw(const LightStorage& light, const geometry::Bounds& bounds_mm, std::span<const ShadowCaster> casters);

  /// The share of the light that arrives at a point of a facet, 0..1, `across` its outward normal of any length: four
  /// neighbouring texels compared, with a bias that grows as the facet tilts away; none where it faces away.
  /// Thread-safe between draws.
  float visibility_at(const glm::vec3& point_mm, const glm::vec3& across) const;

 private:
  /// A point in texels, and how near it is to the light: 1/depth of a point light, −depth of a directional one; linear
  /// over a triangle either way.
  struct Projected {
    float x, y, nearness;
  };
  /// Before the map is fitted: on the plane at depth 1 (or in mm for a directional light).
  Projected project(const glm::vec3& point_mm) const;
  void aim(const LightStorage& light, const geometry::Bounds& bounds_mm);
  void fit(std::span<const ShadowCaster> casters);
  void rasterise(const ShadowCaster& caster, std::span<const Projected> vertices, size_t begin, size_t end,
                 float* nearest) const;

  bool directional_ = false;
  glm::vec3 eye_mm_{0};
  glm::vec3 right_{1, 0, 0}, up_{0, 1, 0}, ahead_{0, 0, 1};
  glm::vec2 low_{0};                                          ///< corner of the map before fitting
  float texels_per_unit_ = 1;                                 ///< of the plane before fitting
  float unit_of_texel_ = 1;                                   ///< its inverse
  std::vector<Projected> vertices_;                           ///< of all casters
  tbb::enumerable_thread_specific<std::vector<float>> maps_;  ///< of each thread: the nearest wins, in whatever order
  int size_px_ = 256;
  std::vector<float> nearest_;  ///< [size_px_²]; the lowest float where nothing is
};

}  // namespace diaphane::render

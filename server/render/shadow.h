// Whether a light is seen from a surface, by rays.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "geometry/topology.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// All meshes of a scene as one ray-tracing scene that is refitted as they move (Embree). One thread calls; work inside
/// is spread over all cores. The same bytes on any number of threads.
class ShadowScene {
 public:
  ShadowScene();
  ~ShadowScene();
  ShadowScene(const ShadowScene&) = delete;
  ShadowScene& operator=(const ShadowScene&) = delete;

  /// Gives slot `slot` (0, 1, …) its triangles and where they are; a slot that had as many of both is refitted.
  void set_mesh(size_t slot, std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions_mm);
  /// Drops slots from `count` on.
  void resize(size_t count);
  /// Makes what was set visible to rays.
  void commit();

  /// The visible share of `light`, 0..1, at each of `points_mm`, which lie on facets with unit normals `facet_normals`.
  /// Hard for a light without a radius; else the share of 16 points of its disc.
  void visibility(const LightStorage& light, std::span<const glm::vec3> points_mm,
                  std::span<const glm::vec3> facet_normals, std::span<float> share) const;
  /// The same at one point, from any thread.
  float visibility_at(const LightStorage& light, const glm::vec3& point_mm, const glm::vec3& normal) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace diaphane::render

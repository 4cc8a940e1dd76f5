// Whether a light is seen from a surface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "render/shadow_map.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// All meshes of a scene as casters of shadows. Hard lights outside the scene are answered by depth maps, others by
/// rays (Embree), whose structure is built when first needed and refitted as meshes move. One thread calls; work inside
/// is spread over all cores. The same bytes on any number of threads.
class ShadowScene {
 public:
  ShadowScene();
  ~ShadowScene();
  ShadowScene(const ShadowScene&) = delete;
  ShadowScene& operator=(const ShadowScene&) = delete;

  /// Takes the casters as they are now, by reference: they must stay until the next call.
  void set_casters(std::span<const ShadowCaster> casters, const geometry::Bounds& bounds_mm);

  /// The visible share of `light`, 0..1, at the centroid of each of `triangles`, seen from in front. Hard for a light
  /// without a radius; else the share of 16 points of its disc.
  void visibility(const LightStorage& light, std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape,
                  std::span<float> share);

  /// Makes visibility_at() answer for the casters of now.
  void prepare_rays();
  /// The same at one point, by rays, from any thread.
  float visibility_at(const LightStorage& light, const glm::vec3& point_mm, const glm::vec3& normal) const;

 private:
  struct Embree;
  void trace(const LightStorage& light, std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape,
             std::span<float> share) const;

  std::vector<ShadowCaster> casters_;
  geometry::Bounds bounds_mm_;
  bool rays_ready_ = false;
  ShadowMap map_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace diaphane::render

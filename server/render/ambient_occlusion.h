// How much of the light from all around bodies hide from each other and from themselves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "glm/vec3.hpp"
#include "render/ambient.h"
#include "render/shadow.h"

namespace diaphane::render {

/// The light around as so many directions, each for as much of the sphere. Values.
struct AmbientDirections {
  float refractive_index = 1;  ///< 1: light enters without Fresnel
  std::vector<glm::vec3> towards;
  std::vector<glm::vec3> radiance;  ///< of the environment's harmonics, not below 0

  /// The share, RGB, of what enters at a `normal` that comes from directions by as much as seen(direction's number,
  /// 0..1) says. 1 where nothing enters.
  template <typename Seen>
  glm::vec3 share(const glm::vec3& normal, const Seen& seen) const {
    glm::vec3 all(0), arriving(0);
    for (size_t k = 0; k < towards.size(); ++k) {
      const float cosine = glm::dot(normal, towards[k]);
      if (!(cosine > 0)) continue;
      const glm::vec3 entering = cosine * entering_share(cosine) * radiance[k];
      all += entering;
      arriving += static_cast<float>(seen(k)) * entering;
    }
    glm::vec3 result(1);
    for (int c = 0; c < 3; ++c) result[c] = all[c] > 0 ? arriving[c] / all[c] : 1.0f;
    return result;
  }

 private:
  float entering_share(float cosine) const;
};

AmbientDirections ambient_directions(const Ambient& ambient, float refractive_index, uint32_t count);

/// Of one mesh, in 48 directions, by depth maps: they answer for facets, as shadows do. Keeps its memory from call to
/// call. One thread calls; work is spread over all cores. The same bytes on any number of threads.
class AmbientOcclusion {
 public:
  static constexpr uint32_t kDirections = 48;

  /// Looks from every direction at the triangles' centroids. `occluders` has the mesh among its casters.
  void look(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape, ShadowScene& occluders);

  /// Weighs what look() saw of the same mesh by the light from each direction.
  void weigh(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape, const Ambient& ambient,
             float refractive_index);

  /// Shares of E, 0..1, three rows (RGB) of one value a triangle, or a vertex: the mean of its triangles. Behind the
  /// last is room for a whole vector.
  const float* of_triangles() const { return of_triangles_.data(); }
  const float* of_vertices() const { return of_vertices_.data(); }
  size_t bytes() const { return seen_.capacity() + 4 * (of_triangles_.capacity() + of_vertices_.capacity()); }

 private:
  std::vector<uint8_t> seen_;  ///< [triangle][direction], 255: all of it
  std::vector<float> visible_;
  std::vector<float> of_triangles_, of_vertices_;
};

}  // namespace diaphane::render

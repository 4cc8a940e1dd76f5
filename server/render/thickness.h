// How thick a body is at a point, and what lies on its other side.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "glm/vec3.hpp"

namespace diaphane::render {

/// Where a ray inward leaves the body.
struct OppositePoint {
  float thickness_mm = std::numeric_limits<float>::infinity();  ///< along the normal; infinite: it does not leave it
  float facing = 0;  ///< cosine between the two walls, 1 where they are parallel
  uint32_t triangle = 0;
  float u = 0, v = 0;  ///< barycentric, of the triangle's second and third corner

  /// Values of vertices there.
  glm::vec3 of(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> values) const {
    const glm::uvec3& t = triangles[triangle];
    return (1 - u - v) * values[t.x] + u * values[t.y] + v * values[t.z];
  }
};

/// One mesh, asked by rays (Embree), whose structure is refitted as the mesh moves. update() by one thread, find() by
/// any.
class ThicknessField {
 public:
  ThicknessField();
  ~ThicknessField();
  ThicknessField(const ThicknessField&) = delete;
  ThicknessField& operator=(const ThicknessField&) = delete;

  /// Takes the mesh as it is now; `triangles` must stay until the next call.
  void update(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape);

  /// Rays a point: one along the normal, the others around it, as light spreads on its way.
  static constexpr size_t kRays = 8;

  /// The opposite points of each point, one after the other, over all cores. A ray that slips through between triangles
  /// is tried again from beside the point.
  std::vector<OppositePoint> find(std::span<const glm::vec3> points_mm, std::span<const glm::vec3> normals) const;

  size_t bytes() const;

 private:
  struct Embree;
  OppositePoint trace(const glm::vec3& start_mm, const glm::vec3& direction, const glm::vec3& normal) const;
  std::unique_ptr<Embree> embree_;
};

}  // namespace diaphane::render

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

/// Where the way inward along the normal leaves the body.
struct OppositePoint {
  float thickness_mm = std::numeric_limits<float>::infinity();  ///< infinite: it does not leave it
  uint32_t triangle = 0;
  glm::vec3 weights{1, 0, 0};  ///< of the triangle's corners
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

  /// A ray that slips through between triangles is tried again from beside the point.
  OppositePoint find(const glm::vec3& point_mm, const glm::vec3& normal) const;
  /// find() at many points, over all cores.
  std::vector<OppositePoint> find(std::span<const glm::vec3> points_mm, std::span<const glm::vec3> normals) const;

  size_t bytes() const;

 private:
  struct Embree;
  OppositePoint trace(const glm::vec3& start_mm, const glm::vec3& normal) const;
  std::unique_ptr<Embree> embree_;
};

}  // namespace diaphane::render

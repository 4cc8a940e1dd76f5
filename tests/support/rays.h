// Rays against a mesh, by Embree.
#pragma once

#include <memory>
#include <optional>

#include "glm/vec3.hpp"
#include "tests/support/meshes.h"

namespace diaphane::testing {

/// Thread-safe once made; `mesh` must not change meanwhile.
class MeshRays {
 public:
  explicit MeshRays(const Mesh& mesh);
  ~MeshRays();

  /// Whether nothing lies between two points.
  bool sees(const glm::vec3& from_mm, const glm::vec3& to_mm) const;

  /// What a ray from a point in a unit direction meets first.
  std::optional<SurfacePoint> first_along(const glm::vec3& from_mm, const glm::vec3& direction) const;

  /// The triangle that a point of the surface lies in, found along the normal there.
  std::optional<SurfacePoint> locate(const glm::vec3& point_mm, const glm::vec3& normal) const;

 private:
  std::optional<SurfacePoint> first_hit(const glm::vec3& from_mm, const glm::vec3& way_mm) const;

  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace diaphane::testing

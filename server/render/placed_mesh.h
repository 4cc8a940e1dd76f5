// One mesh of a scene, placed in millimetres.
#pragma once

#include <memory>
#include <vector>

#include "geometry/shape.h"
#include "glm/mat4x4.hpp"
#include "render/stage_clock.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Follows a scene mesh from revision to revision and places it again only when it moved. One thread.
class PlacedMesh {
 public:
  /// Positions alone. Stage: place.
  void update(const scene::Mesh& mesh, double millimetres_per_unit, StageClock& clock);
  /// Normals too. The mesh of the last update must still be there. Stage: normals.
  void complete_normals(StageClock& clock);

  const geometry::PlacedShape& shape() const { return placed_; }
  const geometry::Bounds& bounds_mm() const { return bounds_mm_; }
  /// Millimetres that a mesh unit is long, on average over directions.
  float unit_mm() const;
  /// Another number whenever positions or normals in millimetres change; no two meshes ever share one.
  uint64_t generation() const { return generation_; }
  /// The scene let go of the mesh that this one follows.
  bool orphaned() const { return topology_.expired(); }

 private:
  std::weak_ptr<const geometry::MeshTopology> topology_;
  std::weak_ptr<const geometry::MeshShape> shape_;
  glm::mat4 scene_from_mesh_{0};
  double millimetres_per_unit_ = 0;
  geometry::PlacedShape placed_;
  std::vector<glm::vec3> scratch_;
  geometry::Bounds bounds_mm_;
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

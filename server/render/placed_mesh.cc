#include "render/placed_mesh.h"

#include <cmath>

#include "glm/matrix.hpp"
#include "render/generation.h"

namespace diaphane::render {
float PlacedMesh::unit_mm() const {
  return static_cast<float>(millimetres_per_unit_ * std::cbrt(std::abs(glm::determinant(glm::mat3(scene_from_mesh_)))));
}

void PlacedMesh::update(const scene::Mesh& mesh, double millimetres_per_unit, StageClock& clock) {
  const bool same = topology_.lock() == mesh.topology && shape_.lock() == mesh.shape &&
                    scene_from_mesh_ == mesh.scene_from_mesh && millimetres_per_unit_ == millimetres_per_unit;
  if (same) {
    clock.sleep("place");
    return;
  }
  clock.run("place", [&] {
    bounds_mm_ = geometry::place_positions(*mesh.shape, mesh.scene_from_mesh, millimetres_per_unit, placed_);
  });
  topology_ = mesh.topology;
  shape_ = mesh.shape;
  scene_from_mesh_ = mesh.scene_from_mesh;
  millimetres_per_unit_ = millimetres_per_unit;
  generation_ = next_generation();
}

void PlacedMesh::complete_normals(StageClock& clock) {
  if (!placed_.normals.empty()) {
    clock.sleep("normals");
    return;
  }
  clock.run("normals",
            [&] { geometry::place_normals(*topology_.lock(), *shape_.lock(), scene_from_mesh_, placed_, scratch_); });
}

}  // namespace diaphane::render

#include "render/placed_mesh.h"

#include <atomic>
#include <cmath>

#include "glm/matrix.hpp"

namespace diaphane::render {
namespace {

uint64_t next_generation() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

}  // namespace

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
    placed_ = geometry::place(*mesh.topology, *mesh.shape, mesh.scene_from_mesh, millimetres_per_unit);
    bounds_mm_ = geometry::bounds_of(placed_.positions_mm);
  });
  topology_ = mesh.topology;
  shape_ = mesh.shape;
  scene_from_mesh_ = mesh.scene_from_mesh;
  millimetres_per_unit_ = millimetres_per_unit;
  generation_ = next_generation();
}

}  // namespace diaphane::render

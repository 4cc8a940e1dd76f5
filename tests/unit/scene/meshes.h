// A mesh for the store's tests.
#pragma once

#include <memory>

#include "geometry/shape.h"
#include "geometry/topology.h"
#include "scene/scene_store.h"

namespace diaphane::scene {

/// One triangle in the material called `material`.
inline NewMesh triangle(std::string material) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  return {std::move(material), glm::mat4(1), *geometry::build_topology(positions, {{0, 1, 2}}),
          std::make_shared<const geometry::MeshShape>(geometry::MeshShape{positions, {}})};
}

inline constexpr MeshCounts kTriangleCounts{3, 1, false};

inline Changed<Mesh> add_triangle(SceneStore& store, std::string_view scene, const std::string& material) {
  auto reservation = store.reserve_mesh({"parent", scene}, {"mesh.material", material}, kTriangleCounts);
  return *store.create_mesh({"parent", scene}, triangle(material), *std::move(reservation));
}

}  // namespace diaphane::scene

// Meshes of the shared data folder, for tests that skip without it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glm/vec3.hpp"

namespace diaphane::tests {

struct LoadedMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// ../shared/data/meshes/NAME beside the source tree, scaled about the origin so that its longest extent is
/// `extent_mm`; nothing where the folder is absent.
std::optional<LoadedMesh> load_shared_mesh(const std::string& name, float extent_mm);

}  // namespace diaphane::tests

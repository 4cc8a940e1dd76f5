// Where a glTF scene puts its meshes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

struct GltfInstance {
  size_t mesh = 0;
  int node = -1;  ///< -1 where no node places the mesh
  std::array<double, 16> scene_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  ///< column-major, affine
};

/// The meshes of the default scene, else of the first, else of all nodes; every mesh once, as it is, where no node of
/// the file has one. Instances that a transform flattens (determinant 0) are left out with a line in `warnings`.
/// kInvalidArgument: a reference to nothing, a node that is reached twice (a cycle, or two parents), a transform that
/// is malformed or not finite.
absl::StatusOr<std::vector<GltfInstance>> place_gltf_meshes(const tinygltf::Model& model, const Source& source,
                                                            std::vector<std::string>& warnings);

}  // namespace diaphane::readers

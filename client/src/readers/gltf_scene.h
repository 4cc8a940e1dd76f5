// Where a glTF scene puts its meshes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "readers/gltf_accessor.h"
#include "readers/gltf_extensions.h"
#include "readers/gltf_matrix.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

struct GltfInstance {
  size_t mesh = 0;
  int node = -1;  ///< -1 where no node places the mesh
  Matrix scene_from_mesh = kIdentity;
};

struct GltfPlacement {
  std::vector<GltfInstance> instances;
  std::vector<std::optional<Matrix>> scene_from_node;  ///< of the nodes that the scene reaches
};

/// The meshes of the default scene, else of the first, else of all nodes; every mesh once, as it is, where no node of
/// the file has one; at each of its transforms where a node has EXT_mesh_gpu_instancing.
/// kInvalidArgument: a reference to nothing, a node that is reached twice (a cycle, or two parents), a transform that
/// is malformed or not finite. kResourceExhausted: more than limits.max_nodes instances.
absl::StatusOr<GltfPlacement> place_gltf_meshes(const tinygltf::Model& model, const GltfExtensions& extensions,
                                                GltfAccessors& accessors, const Source& source);

}  // namespace diaphane::readers

// Skinned glTF meshes in the pose that their joints have at rest.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "diaphane/mesh_data.h"
#include "readers/gltf_accessor.h"
#include "readers/gltf_scene.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// Poses meshes by glTF 2.0 section 3.7.3: scene_from_mesh of a vertex is the mean of scene_from_joint ·
/// joint_from_mesh by its weights, and its node's own transform counts for nothing. Not thread-safe. What it is made
/// from outlives it.
class GltfSkins {
 public:
  static constexpr size_t kMostJoints = 65536;  ///< of one skin; more could not be named

  GltfSkins(const tinygltf::Model& model, const GltfPlacement& placement, GltfAccessors& accessors,
            const Source& source)
      : model_(model), placement_(placement), accessors_(accessors), source_(source) {}

  /// Whether `skin` poses `primitive`: both have what it takes, and the scene reaches every joint. kInvalidArgument
  /// where the skin refers to nothing.
  absl::StatusOr<bool> poses(int skin, const tinygltf::Primitive& primitive);

  /// Moves positions and normals into the scene, and turns the triangles round where the joints mirror most of the
  /// vertices. The skin poses the primitive. Vertices of no weight stay as they are.
  absl::Status pose(int skin, const tinygltf::Primitive& primitive, std::string_view where, MeshData& mesh);

 private:
  using Affine = std::array<float, 12>;  // column-major, three rows

  struct Influences {
    std::vector<GltfFloat4> joints;
    std::vector<GltfFloat4> weights;
  };

  absl::Status load(int skin);
  absl::StatusOr<std::vector<Influences>> read_influences(const tinygltf::Primitive& primitive, uint64_t count,
                                                          std::string_view where);

  const tinygltf::Model& model_;
  const GltfPlacement& placement_;
  GltfAccessors& accessors_;
  const Source& source_;
  int loaded_ = -1;
  bool complete_ = false;                // of the loaded skin: every joint is reached
  std::vector<Affine> scene_from_mesh_;  // by joint of the loaded skin
};

}  // namespace diaphane::readers

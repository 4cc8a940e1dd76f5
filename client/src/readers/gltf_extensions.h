// What glTF extensions say of buffer views, primitives and nodes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"
#include "readers/source.h"

namespace diaphane::readers {

/// The extensions that are read, all that a document keeps.
inline constexpr std::string_view kReadExtensions[] = {
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",      "EXT_mesh_gpu_instancing",
    "KHR_materials_ior",          "KHR_materials_volume",    "KHR_materials_volume_scatter", "KHR_materials_clearcoat",
    "KHR_texture_transform",      "EXT_texture_webp"};

/// EXT_meshopt_compression, KHR_meshopt_compression: where the compressed bytes of a buffer view lie.
struct GltfMeshopt {
  uint64_t buffer = 0;
  uint64_t byte_offset = 0;
  uint64_t byte_length = 0;
  uint64_t byte_stride = 0;  ///< of one decoded element
  uint64_t count = 0;        ///< of decoded elements
  std::string mode;
  std::string filter;
};

/// KHR_draco_mesh_compression: the compressed bytes of a primitive, and which of its attributes is which.
struct GltfDraco {
  int buffer_view = -1;
  int indices = -1;                            ///< the primitive's own
  std::map<std::string, uint32_t> unique_ids;  ///< by attribute, "POSITION"
};

/// EXT_mesh_gpu_instancing: accessors of the transforms that a node places its mesh by; -1 for those left out.
struct GltfInstancing {
  int translation = -1;
  int rotation = -1;
  int scale = -1;
};

struct GltfExtensions {
  std::unordered_map<size_t, GltfMeshopt> meshopt_of_view;
  std::map<std::pair<size_t, size_t>, GltfDraco> draco_of_primitive;  ///< by mesh and primitive
  std::unordered_map<size_t, GltfInstancing> instancing_of_node;
};

/// Takes what is read of them out of `root`, whose lists are arrays: no buffer view, primitive or node has extensions
/// left, and what Draco compressed has no indices. kInvalidArgument where one has a member of the wrong type. Nothing
/// that they refer to is checked.
absl::StatusOr<GltfExtensions> take_gltf_extensions(nlohmann::json& root, const Source& source);

}  // namespace diaphane::readers

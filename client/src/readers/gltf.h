// glTF 2.0 and GLB.
#pragma once

#include <string>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Reads the default scene (or the first, or every node where there is no scene): a mesh per primitive and node (and
/// instance, EXT_mesh_gpu_instancing), with the node's transform. Triangles, strips and fans; quantised, normalised and
/// sparse accessors; Draco's and meshoptimizer's compression; default morph weights; skins in the pose of their joints
/// at rest, in scene units. Materials, images, cameras and animations are not looked at. External buffers are opened
/// inside source.folder only. kUnimplemented: glTF 1, and other required extensions, by name. Errors: read_mesh_file().
absl::StatusOr<LoadedFile> read_gltf(std::string bytes, const Source& source);

}  // namespace diaphane::readers

// glTF 2.0 and GLB.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "readers/gltf_buffers.h"
#include "readers/gltf_document.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// What the file is read for.
enum class GltfUse {
  kMeshes,  ///< read_mesh_file()
  kRest,    ///< all meshes in scene units, those of no volume too: AnimatedFile::rest()
  kPose     ///< the same without looks
};

/// A document with its buffers, to be read in one pose or several. Thread-safe (const).
struct GltfFile {
  Source source;
  GltfDocument document;
  GltfBuffers buffers;
  tinygltf::Model model;
};

/// Parses; errors as read_gltf's. Stays where it is: its buffers may lie in its document.
absl::StatusOr<std::unique_ptr<GltfFile>> open_gltf(std::string bytes, const Source& source);

/// Reads `file` with the nodes of `model`, which is its own or a copy in another pose.
absl::StatusOr<LoadedFile> read_gltf_model(const GltfFile& file, const tinygltf::Model& model, GltfUse use);

/// Reads the default scene (or the first, or every node where there is no scene): a mesh per primitive and node (and
/// instance, EXT_mesh_gpu_instancing), with the node's transform. Triangles, strips and fans; quantised, normalised and
/// sparse accessors; Draco's and meshoptimizer's compression; default morph weights; skins in the pose of their joints
/// at rest, in scene units. Cameras and animations are not looked at. External buffers are opened
/// inside source.folder only. kUnimplemented: glTF 1, and other required extensions, by name. Errors: read_mesh_file().
absl::StatusOr<LoadedFile> read_gltf(std::string bytes, const Source& source);

}  // namespace diaphane::readers

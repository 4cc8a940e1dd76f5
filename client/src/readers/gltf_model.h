// tinygltf's view of a document: what refers to what.
#pragma once

#include "absl/status/statusor.h"
#include "readers/gltf_document.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// Accessors, buffer views, meshes, nodes, skins and scenes of `document`. Nothing that one names of another has been
/// checked. Buffers are left out (see load_gltf_buffers()), and tinygltf is built without any access to files.
absl::StatusOr<tinygltf::Model> parse_gltf_model(GltfDocument& document, const Source& source);

}  // namespace diaphane::readers

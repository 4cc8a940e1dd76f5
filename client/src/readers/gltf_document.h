// The JSON of a glTF file and the binary chunk of a GLB file, before anything is made of them.
#pragma once

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"
#include "readers/gltf_extensions.h"
#include "readers/source.h"

namespace diaphane::readers {

struct GltfDocument {
  /// The root object: asset, scenes, nodes, meshes, skins, accessors, bufferViews, buffers and the lists of extensions,
  /// all arrays where they are there, of the types that glTF 2.0 asks for. Without extras, and without the extension
  /// objects that are in `extensions`; nesting and values bounded; integers beyond 32 bits as floating-point numbers.
  nlohmann::json json;
  GltfExtensions extensions;
  nlohmann::json looks;       ///< what take_gltf_looks() took
  nlohmann::json animations;  ///< what take_gltf_animations() took

  std::string bytes;  ///< of a GLB file, which binary_chunk() lies in
  size_t chunk_offset = 0;
  size_t chunk_size = 0;
  bool has_chunk = false;

  std::string_view binary_chunk() const { return std::string_view(bytes).substr(chunk_offset, chunk_size); }
};

/// Parses either kind of file. kInvalidArgument malformed; kResourceExhausted too much JSON or too many nodes;
/// kUnimplemented glTF 1 and extensions that the file requires and the reader does not know.
absl::StatusOr<GltfDocument> parse_gltf_document(std::string bytes, const Source& source);

}  // namespace diaphane::readers

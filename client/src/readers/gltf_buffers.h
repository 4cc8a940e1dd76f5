// The bytes that a glTF document refers to.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "readers/gltf_document.h"

namespace diaphane::readers {

/// The buffers of a document, in its order. Those of the GLB chunk lie in the document, which has to outlive this.
class GltfBuffers {
 public:
  /// Loads all: the GLB chunk, data URIs, and files inside source.folder (relative, no "..", no link that leads out).
  /// kInvalidArgument a buffer shorter than its byteLength, or a URI that may not be followed; kNotFound a file that is
  /// missing; kResourceExhausted more than limits.max_file_bytes in all. A fallback of meshopt's without a URI is
  /// empty.
  static absl::StatusOr<GltfBuffers> load(GltfDocument& document, const Source& source);

  size_t size() const { return views_.size(); }
  std::string_view operator[](size_t buffer) const { return views_[buffer]; }

 private:
  std::vector<std::vector<unsigned char>> decoded_;
  std::deque<std::string> files_;  // stay where they are as more come
  std::vector<std::string_view> views_;
};

/// The bytes of a data URI or of a file inside source.folder, as above; at most limits.max_file_bytes. Errors in the
/// name of `source`.
absl::StatusOr<std::string> load_gltf_uri(const std::string& uri, const Source& source);

}  // namespace diaphane::readers

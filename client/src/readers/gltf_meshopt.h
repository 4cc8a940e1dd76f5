// Buffer views that meshoptimizer compressed.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

#include "absl/status/statusor.h"
#include "readers/gltf_buffers.h"
#include "readers/gltf_extensions.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Decodes EXT_meshopt_compression and KHR_meshopt_compression, each view once, when it is first asked for. Not
/// thread-safe. What it is made from outlives it.
class GltfMeshoptViews {
 public:
  static constexpr uint64_t kMostDecodedBytes = uint64_t{256} << 20;  ///< of all views

  GltfMeshoptViews(const GltfExtensions& extensions, const GltfBuffers& buffers, const Source& source)
      : extensions_(extensions), buffers_(buffers), source_(source) {}

  bool has(size_t view) const { return extensions_.meshopt_of_view.contains(view); }

  /// The bytes of a view that it has; they stay where they are. kInvalidArgument where the extension contradicts itself
  /// or the data; kUnimplemented a filter or a version of the codec that the decoder does not know; kResourceExhausted
  /// past kMostDecodedBytes, before any is allocated.
  absl::StatusOr<std::string_view> decode(size_t view);

 private:
  absl::StatusOr<std::string_view> compressed_bytes(const GltfMeshopt& meshopt, std::string_view where) const;

  const GltfExtensions& extensions_;
  const GltfBuffers& buffers_;
  const Source& source_;
  std::unordered_map<size_t, std::unique_ptr<char[]>> decoded_;
  uint64_t bytes_left_ = kMostDecodedBytes;
};

}  // namespace diaphane::readers

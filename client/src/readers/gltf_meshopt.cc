#include "readers/gltf_meshopt.h"

#include "fmt/format.h"
#include "meshoptimizer.h"

namespace diaphane::readers {
namespace {

constexpr uint64_t kLargestStride = 256;

// The first byte is the codec's name above its version.
bool is_later_version(const GltfMeshopt& m, std::string_view compressed) {
  if (compressed.empty()) return false;
  const auto first = static_cast<unsigned char>(compressed.front());
  if (m.mode == "ATTRIBUTES") return first > 0xa0 && first <= 0xaf;
  return m.mode == "TRIANGLES" ? first > 0xe1 && first <= 0xef : first > 0xd1 && first <= 0xdf;
}

// What the decoder takes for granted.
std::string_view bad_shape(const GltfMeshopt& m) {
  if (m.mode == "ATTRIBUTES") {
    if (m.byte_stride == 0 || m.byte_stride % 4 != 0 || m.byte_stride > kLargestStride) {
      return "byteStride must be a multiple of 4, at most 256";
    }
    if (m.filter == "OCTAHEDRAL" && m.byte_stride != 4 && m.byte_stride != 8) return "byteStride must be 4 or 8";
    if (m.filter == "QUATERNION" && m.byte_stride != 8) return "byteStride must be 8";
    return {};
  }
  if (m.byte_stride != 2 && m.byte_stride != 4) return "byteStride must be 2 or 4";
  if (m.mode == "TRIANGLES" && m.count % 3 != 0) return "count must be a multiple of 3";
  return m.filter == "NONE" ? std::string_view() : "only attributes have a filter";
}

bool is_known_filter(std::string_view filter) {
  return filter == "NONE" || filter == "OCTAHEDRAL" || filter == "QUATERNION" || filter == "EXPONENTIAL";
}

bool decode_into(char* decoded, const GltfMeshopt& m, std::string_view compressed) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.data());
  if (m.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(decoded, m.count, m.byte_stride, bytes, compressed.size()) == 0;
  }
  if (m.mode == "INDICES") {
    return meshopt_decodeIndexSequence(decoded, m.count, m.byte_stride, bytes, compressed.size()) == 0;
  }
  if (meshopt_decodeVertexBuffer(decoded, m.count, m.byte_stride, bytes, compressed.size()) != 0) return false;
  if (m.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded, m.count, m.byte_stride);
  if (m.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded, m.count, m.byte_stride);
  if (m.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded, m.count, m.byte_stride);
  return true;
}

}  // namespace

absl::StatusOr<std::string_view> GltfMeshoptViews::compressed_bytes(const GltfMeshopt& meshopt,
                                                                    std::string_view where) const {
  if (meshopt.buffer >= buffers_.size()) {
    return source_.malformed(fmt::format("buffer {}", meshopt.buffer), where,
                             fmt::format("there are {}", buffers_.size()));
  }
  const std::string_view bytes = buffers_[meshopt.buffer];
  if (meshopt.byte_offset > bytes.size() || meshopt.byte_length > bytes.size() - meshopt.byte_offset) {
    return source_.malformed(fmt::format("bytes {} + {}", meshopt.byte_offset, meshopt.byte_length), where,
                             fmt::format("the buffer has {}", bytes.size()));
  }
  return bytes.substr(meshopt.byte_offset, meshopt.byte_length);
}

absl::StatusOr<std::string_view> GltfMeshoptViews::decode(size_t view) {
  const GltfMeshopt& meshopt = extensions_.meshopt_of_view.at(view);
  const std::string where = fmt::format("meshopt compression of bufferView {}", view);
  if (const auto known = decoded_.find(view); known != decoded_.end()) {
    return std::string_view(known->second.get(), meshopt.count * meshopt.byte_stride);
  }
  if (meshopt.mode != "ATTRIBUTES" && meshopt.mode != "TRIANGLES" && meshopt.mode != "INDICES") {
    return source_.malformed(fmt::format("mode {}", in_quotes(meshopt.mode)), where,
                             "must be ATTRIBUTES, TRIANGLES or INDICES");
  }
  if (!is_known_filter(meshopt.filter)) {
    return source_.unsupported(fmt::format("filter {}", in_quotes(meshopt.filter)), where);
  }
  if (const std::string_view range = bad_shape(meshopt); !range.empty()) {
    return source_.malformed(fmt::format("{} elements of {} bytes", meshopt.count, meshopt.byte_stride), where, range);
  }
  const absl::StatusOr<std::string_view> compressed = compressed_bytes(meshopt, where);
  if (!compressed.ok()) return compressed.status();
  if (meshopt.count > bytes_left_ / meshopt.byte_stride) {
    return source_.error(absl::StatusCode::kResourceExhausted,
                         fmt::format("{} elements of {} bytes", meshopt.count, meshopt.byte_stride), where,
                         fmt::format("must be at most {} bytes in all", kMostDecodedBytes));
  }
  const uint64_t size = meshopt.count * meshopt.byte_stride;
  auto decoded = std::make_unique<char[]>(size);
  if (!decode_into(decoded.get(), meshopt, *compressed)) {
    if (is_later_version(meshopt, *compressed)) return source_.unsupported("a later version of the codec", where);
    return source_.malformed("cannot be decoded", where);
  }
  bytes_left_ -= size;
  return std::string_view(decoded_.emplace(view, std::move(decoded)).first->second.get(), size);
}

}  // namespace diaphane::readers

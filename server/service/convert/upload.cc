#include "service/convert/upload.h"

#include <bit>
#include <cstring>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "scene/mesh_memory.h"
#include "service/sha256.h"

namespace diaphane::service {
namespace {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian and read as they are");
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

absl::StatusOr<PayloadSpec> make_spec(const scene::MeshCounts& counts, uint64_t total_bytes,
                                      const std::string& sha256) {
  if (counts.vertex_count == 0) return base::invalid_field("vertex_count", "at least 1", 0);
  const uint64_t needed = scene::payload_bytes(counts);
  if (total_bytes != needed) {
    return base::invalid_field("total_bytes", fmt::format("{}, as the counts say", needed),
                               fmt::format("{}", total_bytes));
  }
  if (sha256.size() != Sha256::kBytes) {
    return base::invalid_field("sha256", "32 bytes", fmt::format("{} bytes", sha256.size()));
  }
  return PayloadSpec{counts, total_bytes, sha256};
}

// Moves `count` elements from the front of `bytes` to a vector.
template <typename T>
std::vector<T> take(std::span<const char>& bytes, size_t count) {
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), count * sizeof(T));
  bytes = bytes.subspan(count * sizeof(T));
  return values;
}

}  // namespace

absl::StatusOr<PayloadSpec> from_proto(const v1::MeshHeader& message) {
  if (message.triangle_count() == 0) return base::invalid_field("triangle_count", "at least 1", 0);
  for (const auto& [field, given] : {std::pair("has_texture_coordinates", message.has_texture_coordinates()),
                                     std::pair("has_colors", message.has_colors())}) {
    if (given) return base::field_error(absl::StatusCode::kUnimplemented, {field, "true", "false"});
  }
  return make_spec({message.vertex_count(), message.triangle_count(), message.has_normals()}, message.total_bytes(),
                   message.sha256());
}

absl::StatusOr<PayloadSpec> from_proto(const v1::PositionsHeader& message) {
  return make_spec({message.vertex_count(), 0, message.has_normals()}, message.total_bytes(), message.sha256());
}

absl::StatusOr<PayloadArrays> read_arrays(const PayloadSpec& spec, std::span<const char> bytes) {
  PayloadArrays arrays;
  arrays.positions = take<glm::vec3>(bytes, spec.counts.vertex_count);
  if (spec.counts.has_normals) arrays.normals = take<glm::vec3>(bytes, spec.counts.vertex_count);
  arrays.triangles = take<glm::uvec3>(bytes, spec.counts.triangle_count);
  if (absl::Status finite = geometry::check_finite(arrays.positions, "positions"); !finite.ok()) return finite;
  if (absl::Status finite = geometry::check_finite(arrays.normals, "normals"); !finite.ok()) return finite;
  return arrays;
}

}  // namespace diaphane::service

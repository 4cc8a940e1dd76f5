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

constexpr float kLargestTextureCoordinate = 1e6f;

template <int kChannels, typename T>
absl::Status check_values(const std::vector<T>& values, std::string_view field, float lowest, float highest) {
  for (size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < kChannels; ++c) {
      const float value = values[i][c];
      // Written so that NaN fails too.
      if (value >= lowest && value <= highest) continue;
      return base::invalid_field(fmt::format("{}[{}][{}]", field, i, c), fmt::format("{:g}..{:g}", lowest, highest),
                                 value);
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<PayloadSpec> from_proto(const v1::MeshHeader& message) {
  if (message.triangle_count() == 0) return base::invalid_field("triangle_count", "at least 1", 0);
  if (message.morph_target_count() > kMaxMorphTargets) {
    return base::invalid_field("morph_target_count", fmt::format("at most {}", kMaxMorphTargets),
                               message.morph_target_count());
  }
  return make_spec({message.vertex_count(), message.triangle_count(), message.has_normals(),
                    message.has_texture_coordinates(), message.has_colors(), message.morph_target_count()},
                   message.total_bytes(), message.sha256());
}

absl::StatusOr<PayloadSpec> from_proto(const v1::PositionsHeader& message) {
  return make_spec({message.vertex_count(), 0, message.has_normals()}, message.total_bytes(), message.sha256());
}

absl::StatusOr<PayloadArrays> read_arrays(const PayloadSpec& spec, std::span<const char> bytes) {
  PayloadArrays arrays;
  arrays.positions = take<glm::vec3>(bytes, spec.counts.vertex_count);
  if (spec.counts.has_normals) arrays.normals = take<glm::vec3>(bytes, spec.counts.vertex_count);
  std::vector<glm::vec2>& coordinates = arrays.attributes.texture_coordinates;
  std::vector<glm::vec3>& colors = arrays.attributes.colors;
  if (spec.counts.has_texture_coordinates) coordinates = take<glm::vec2>(bytes, spec.counts.vertex_count);
  if (spec.counts.has_colors) colors = take<glm::vec3>(bytes, spec.counts.vertex_count);
  arrays.triangles = take<glm::uvec3>(bytes, spec.counts.triangle_count);
  arrays.morph_targets.count = spec.counts.morph_target_count;
  arrays.morph_targets.displacements =
      take<glm::vec3>(bytes, size_t{spec.counts.vertex_count} * spec.counts.morph_target_count);
  absl::Status displaced = geometry::check_finite(arrays.morph_targets.displacements, "morph_targets");
  if (!displaced.ok()) return displaced;
  if (absl::Status finite = geometry::check_finite(arrays.positions, "positions"); !finite.ok()) return finite;
  if (absl::Status finite = geometry::check_finite(arrays.normals, "normals"); !finite.ok()) return finite;
  absl::Status within =
      check_values<2>(coordinates, "texture_coordinates", -kLargestTextureCoordinate, kLargestTextureCoordinate);
  if (within.ok()) within = check_values<3>(colors, "colors", 0, 1);
  if (!within.ok()) return within;
  return arrays;
}

}  // namespace diaphane::service

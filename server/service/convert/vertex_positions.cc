#include "service/convert/vertex_positions.h"

#include <cstring>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "meshoptimizer.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

using Steps = glm::vec<3, uint16_t>;
static_assert(sizeof(glm::vec3) == 12 && sizeof(Steps) == 6);

// The codec gives each sixteen bytes of a kind two bits at least.
constexpr uint64_t kMostExpansion = 64;

/// The elements of `bytes`, as they are or out of the codec, where each takes `stride` bytes.
template <typename T>
absl::StatusOr<std::vector<T>> elements_of(std::string_view field, const std::string& bytes, size_t stride,
                                           const v1::VertexPositions& message) {
  const auto indices = static_cast<uint64_t>(message.indices_size());
  const uint64_t coded = message.meshopt_count();
  if (coded == 0) {
    if (bytes.empty() || bytes.size() % sizeof(T) != 0) {
      return base::invalid_field(field, fmt::format("whole positions of {} bytes, at least one", sizeof(T)),
                                 fmt::format("{} bytes", bytes.size()));
    }
    if (indices != 0 && bytes.size() != sizeof(T) * indices) {
      return base::invalid_field(field, fmt::format("{} bytes, as many positions as indices", sizeof(T) * indices),
                                 fmt::format("{} bytes", bytes.size()));
    }
    std::vector<T> elements(bytes.size() / sizeof(T));
    std::memcpy(elements.data(), bytes.data(), bytes.size());
    return elements;
  }
  if (indices != 0 && indices != coded) {
    return base::invalid_field("positions.meshopt_count", fmt::format("{}, as many as indices", indices),
                               fmt::format("{}", coded));
  }
  if (coded * stride > kMostExpansion * bytes.size()) {
    return base::invalid_field(
        "positions.meshopt_count",
        fmt::format("what {} bytes can hold, at most {}", bytes.size(), kMostExpansion * bytes.size() / stride),
        fmt::format("{}", coded));
  }
  std::string decoded(coded * stride, '\0');
  if (meshopt_decodeVertexBuffer(decoded.data(), coded, stride, reinterpret_cast<const unsigned char*>(bytes.data()),
                                 bytes.size()) != 0) {
    return base::invalid_field(field,
                               fmt::format("{} elements of {} bytes by meshoptimizer's vertex codec", coded, stride),
                               fmt::format("{} bytes that are not", bytes.size()));
  }
  std::vector<T> elements(coded);
  for (uint64_t i = 0; i < coded; ++i) std::memcpy(&elements[i], &decoded[i * stride], sizeof(T));
  return elements;
}

absl::StatusOr<std::vector<glm::vec3>> plain_positions(const v1::VertexPositions& message) {
  auto positions = elements_of<glm::vec3>("positions.float32", message.float32(), sizeof(glm::vec3), message);
  if (!positions.ok()) return positions.status();
  if (absl::Status finite = geometry::check_finite(*positions, "positions.float32"); !finite.ok()) return finite;
  return positions;
}

absl::StatusOr<std::vector<glm::vec3>> quantized_positions(const v1::VertexPositions& message) {
  const v1::QuantizedPositions& quantized = message.quantized();
  const auto steps =
      elements_of<Steps>("positions.quantized.uint16", quantized.uint16(), 4 * sizeof(uint16_t), message);
  if (!steps.ok()) return steps.status();
  const auto lowest = position_from_proto(quantized.lowest(), "positions.quantized.lowest");
  if (!lowest.ok()) return lowest.status();
  const auto highest = position_from_proto(quantized.highest(), "positions.quantized.highest");
  if (!highest.ok()) return highest.status();
  std::vector<glm::vec3> positions;
  positions.reserve(steps->size());
  // In double, so that the ends are met.
  const glm::dvec3 first(*lowest), step = (glm::dvec3(*highest) - first) / 65535.0;
  for (const Steps& s : *steps) positions.emplace_back(first + glm::dvec3(s) * step);
  return positions;
}

}  // namespace

absl::StatusOr<scene::PositionsPatch> from_proto(const v1::VertexPositions& message) {
  absl::StatusOr<std::vector<glm::vec3>> positions =
      base::invalid_field("positions.values", "float32 or quantized", "none");
  if (message.values_case() == v1::VertexPositions::kFloat32) positions = plain_positions(message);
  if (message.has_quantized()) positions = quantized_positions(message);
  if (!positions.ok()) return positions.status();
  return scene::PositionsPatch{
      {message.indices().begin(), message.indices().end()}, *std::move(positions), message.displacements()};
}

}  // namespace diaphane::service

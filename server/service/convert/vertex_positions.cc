#include "service/convert/vertex_positions.h"

#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "meshoptimizer.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

using Steps = glm::vec<3, uint16_t>;
// As the codec has them: its elements are of four bytes or a multiple.
using PaddedSteps = glm::vec<4, uint16_t>;
static_assert(sizeof(glm::vec3) == 12 && sizeof(Steps) == 6 && sizeof(PaddedSteps) == 8);

// The codec gives each sixteen bytes of a kind two bits at least.
constexpr uint64_t kMostExpansion = 64;

uint64_t most_elements(size_t coded_bytes, size_t each) { return kMostExpansion * coded_bytes / each; }

/// The elements of `bytes` as they are.
template <typename Element>
absl::StatusOr<std::vector<Element>> plain(std::string_view field, std::string_view bytes,
                                           const v1::VertexPositions& message) {
  const auto indices = static_cast<size_t>(message.indices_size());
  const std::string got = fmt::format("{} bytes", bytes.size());
  if (bytes.empty() || bytes.size() % sizeof(Element) != 0) {
    return base::invalid_field(field, fmt::format("whole positions of {} bytes, at least one", sizeof(Element)), got);
  }
  if (indices != 0 && bytes.size() != sizeof(Element) * indices) {
    return base::invalid_field(field, fmt::format("{} bytes, as many positions as indices", sizeof(Element) * indices),
                               got);
  }
  // Copied once, into memory that nothing wrote before; a string's bytes are aligned for more than this.
  const auto* first = reinterpret_cast<const Element*>(bytes.data());
  return std::vector<Element>(first, first + bytes.size() / sizeof(Element));
}

/// The elements that the codec made `bytes` of.
template <typename Element>
absl::StatusOr<std::vector<Element>> decoded(std::string_view field, std::string_view bytes,
                                             const v1::VertexPositions& message) {
  const auto indices = static_cast<uint32_t>(message.indices_size());
  const uint32_t count = message.meshopt_count();
  if (indices != 0 && indices != count) {
    return base::invalid_field("positions.meshopt_count", fmt::format("{}, as many as indices", indices),
                               fmt::format("{}", count));
  }
  if (count > most_elements(bytes.size(), sizeof(Element))) {
    return base::invalid_field(
        "positions.meshopt_count",
        fmt::format("what {} bytes can hold, at most {}", bytes.size(), most_elements(bytes.size(), sizeof(Element))),
        fmt::format("{}", count));
  }
  std::vector<Element> elements(count);
  if (meshopt_decodeVertexBuffer(elements.data(), count, sizeof(Element),
                                 reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()) == 0) {
    return elements;
  }
  return base::invalid_field(
      field, fmt::format("{} elements of {} bytes by meshoptimizer's vertex codec", count, sizeof(Element)),
      fmt::format("{} bytes that are not", bytes.size()));
}

absl::StatusOr<std::vector<glm::vec3>> float_positions(const v1::VertexPositions& message) {
  constexpr std::string_view kField = "positions.float32";
  absl::StatusOr<std::vector<glm::vec3>> positions = message.meshopt_count() == 0
                                                         ? plain<glm::vec3>(kField, message.float32(), message)
                                                         : decoded<glm::vec3>(kField, message.float32(), message);
  if (!positions.ok()) return positions;
  if (absl::Status finite = geometry::check_finite(*positions, kField); !finite.ok()) return finite;
  return positions;
}

template <typename Element>
absl::StatusOr<std::vector<glm::vec3>> in_box(const absl::StatusOr<std::vector<Element>>& steps,
                                              const v1::QuantizedPositions& box) {
  if (!steps.ok()) return steps.status();
  const auto lowest = position_from_proto(box.lowest(), "positions.quantized.lowest");
  if (!lowest.ok()) return lowest.status();
  const auto highest = position_from_proto(box.highest(), "positions.quantized.highest");
  if (!highest.ok()) return highest.status();
  std::vector<glm::vec3> positions(steps->size());
  // A mean of the ends, so that they are met.
  for (size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3 share = glm::vec3((*steps)[i]) / 65535.f;
    positions[i] = *lowest * (1.f - share) + *highest * share;
  }
  return positions;
}

absl::StatusOr<std::vector<glm::vec3>> quantized_positions(const v1::VertexPositions& message) {
  constexpr std::string_view kField = "positions.quantized.uint16";
  const v1::QuantizedPositions& box = message.quantized();
  return message.meshopt_count() == 0 ? in_box(plain<Steps>(kField, box.uint16(), message), box)
                                      : in_box(decoded<PaddedSteps>(kField, box.uint16(), message), box);
}

}  // namespace

absl::StatusOr<scene::PositionsPatch> from_proto(const v1::VertexPositions& message) {
  absl::StatusOr<std::vector<glm::vec3>> positions =
      base::invalid_field("positions.values", "float32 or quantized", "none");
  if (message.values_case() == v1::VertexPositions::kFloat32) positions = float_positions(message);
  if (message.has_quantized()) positions = quantized_positions(message);
  if (!positions.ok()) return positions.status();
  return scene::PositionsPatch{
      {message.indices().begin(), message.indices().end()}, *std::move(positions), message.displacements()};
}

uint64_t decoded_bytes(const v1::VertexPositions& message) {
  const bool quantized = message.has_quantized();
  const size_t coded = quantized ? message.quantized().uint16().size() : message.float32().size();
  const size_t each = quantized ? sizeof(PaddedSteps) : sizeof(glm::vec3);
  const uint64_t count = message.meshopt_count();
  if (count > most_elements(coded, each)) return 0;
  return count * (quantized ? each + sizeof(glm::vec3) : each);
}

}  // namespace diaphane::service

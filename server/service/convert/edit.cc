#include "service/convert/edit.h"

#include <cstring>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "service/convert/check.h"
#include "service/convert/environment.h"
#include "service/convert/light.h"
#include "service/convert/material.h"
#include "service/convert/mesh.h"

namespace diaphane::service {
namespace {

constexpr int kMostChanges = 256;

absl::Status check_bytes(std::string_view field, const std::string& bytes, size_t each, size_t count) {
  if (bytes.empty() || bytes.size() % each != 0) {
    return base::invalid_field(field, fmt::format("whole positions of {} bytes, at least one", each),
                               fmt::format("{} bytes", bytes.size()));
  }
  if (count == 0 || bytes.size() == each * count) return absl::OkStatus();
  return base::invalid_field(field, fmt::format("{} bytes, as many positions as indices", each * count),
                             fmt::format("{} bytes", bytes.size()));
}

absl::StatusOr<std::vector<glm::vec3>> plain_positions(const std::string& bytes, size_t count) {
  if (absl::Status sized = check_bytes("positions.float32", bytes, sizeof(glm::vec3), count); !sized.ok()) return sized;
  std::vector<glm::vec3> positions(bytes.size() / sizeof(glm::vec3));
  std::memcpy(positions.data(), bytes.data(), bytes.size());
  if (absl::Status finite = geometry::check_finite(positions, "positions.float32"); !finite.ok()) return finite;
  return positions;
}

absl::StatusOr<std::vector<glm::vec3>> quantized_positions(const v1::QuantizedPositions& message, size_t count) {
  using Steps = glm::vec<3, uint16_t>;
  static_assert(sizeof(Steps) == 6);
  const std::string& bytes = message.uint16();
  absl::Status sized = check_bytes("positions.quantized.uint16", bytes, sizeof(Steps), count);
  if (!sized.ok()) return sized;
  const auto lowest = position_from_proto(message.lowest(), "positions.quantized.lowest");
  if (!lowest.ok()) return lowest.status();
  const auto highest = position_from_proto(message.highest(), "positions.quantized.highest");
  if (!highest.ok()) return highest.status();
  std::vector<Steps> steps(bytes.size() / sizeof(Steps));
  std::memcpy(steps.data(), bytes.data(), bytes.size());
  std::vector<glm::vec3> positions;
  positions.reserve(steps.size());
  // In double, so that the ends are met.
  const glm::dvec3 first(*lowest), step = (glm::dvec3(*highest) - first) / 65535.0;
  for (const Steps& s : steps) positions.emplace_back(first + glm::dvec3(s) * step);
  return positions;
}

absl::StatusOr<scene::SceneChange> change_of(const v1::VertexPositions& message) {
  const auto count = static_cast<size_t>(message.indices_size());
  absl::StatusOr<std::vector<glm::vec3>> positions =
      base::invalid_field("positions.values", "float32 or quantized", "none");
  if (message.values_case() == v1::VertexPositions::kFloat32) positions = plain_positions(message.float32(), count);
  if (message.has_quantized()) positions = quantized_positions(message.quantized(), count);
  if (!positions.ok()) return positions.status();
  return scene::SceneChange{message.mesh(), scene::PositionsPatch{{message.indices().begin(), message.indices().end()},
                                                                  *std::move(positions)}};
}

template <typename Patch>
absl::StatusOr<scene::SceneChange> change_of(const std::string& name, absl::StatusOr<Patch> patch) {
  if (!patch.ok()) return patch.status();
  return scene::SceneChange{name, *std::move(patch)};
}

absl::StatusOr<scene::SceneChange> from_proto(const v1::SceneChange& message) {
  switch (message.change_case()) {
    case v1::SceneChange::kPositions:
      return change_of(message.positions());
    case v1::SceneChange::kMesh:
      return change_of(message.mesh().mesh().name(),
                       service::from_proto(message.mesh().mesh(), message.mesh().update_mask()));
    case v1::SceneChange::kMaterial:
      return change_of(message.material().material().name(), service::from_proto(message.material()));
    case v1::SceneChange::kLight:
      return change_of(message.light().light().name(),
                       service::from_proto(message.light().light(), message.light().update_mask()));
    case v1::SceneChange::kEnvironment:
      return change_of(message.environment().environment().name(),
                       service::from_proto(message.environment().environment(), message.environment().update_mask()));
    case v1::SceneChange::CHANGE_NOT_SET:
      break;
  }
  return base::invalid_field("change", "positions, mesh, material, light or environment", "none");
}

}  // namespace

absl::StatusOr<std::vector<scene::SceneChange>> from_proto(const v1::SceneEdit& message) {
  if (message.changes_size() < 1 || message.changes_size() > kMostChanges) {
    return base::invalid_field("changes", fmt::format("1..{}", kMostChanges), message.changes_size());
  }
  std::vector<scene::SceneChange> changes;
  for (int i = 0; i < message.changes_size(); ++i) {
    absl::StatusOr<scene::SceneChange> change = from_proto(message.changes(i));
    if (!change.ok()) return base::within(fmt::format("changes[{}].", i), change.status());
    changes.push_back(*std::move(change));
  }
  return changes;
}

}  // namespace diaphane::service

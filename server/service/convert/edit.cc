#include "service/convert/edit.h"

#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/check.h"
#include "service/convert/environment.h"
#include "service/convert/light.h"
#include "service/convert/material.h"
#include "service/convert/mesh.h"
#include "service/convert/vertex_positions.h"

namespace diaphane::service {
namespace {

constexpr int kMostChanges = 256;
constexpr double kLargestWeight = 1e6;

absl::StatusOr<scene::WeightsPatch> from_proto(const v1::MorphWeights& message) {
  scene::WeightsPatch patch{{message.weights().begin(), message.weights().end()}};
  for (size_t i = 0; i < patch.weights.size(); ++i) {
    absl::Status status =
        check_range(fmt::format("weights.weights[{}]", i), patch.weights[i], -kLargestWeight, kLargestWeight);
    if (!status.ok()) return status;
  }
  return patch;
}

absl::StatusOr<scene::SpherePatch> from_proto(const v1::SphereMorph& message) {
  if (absl::Status status = check_range("sphere.amount", message.amount(), 0, 1); !status.ok()) return status;
  return scene::SpherePatch{message.amount()};
}

template <typename Patch>
absl::StatusOr<scene::SceneChange> change_of(const std::string& name, absl::StatusOr<Patch> patch) {
  if (!patch.ok()) return patch.status();
  return scene::SceneChange{name, *std::move(patch)};
}

absl::StatusOr<scene::SceneChange> from_proto(const v1::SceneChange& message) {
  switch (message.change_case()) {
    case v1::SceneChange::kPositions:
      return change_of(message.positions().mesh(), service::from_proto(message.positions()));
    case v1::SceneChange::kWeights:
      return change_of(message.weights().mesh(), from_proto(message.weights()));
    case v1::SceneChange::kSphere:
      return change_of(message.sphere().mesh(), from_proto(message.sphere()));
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
  return base::invalid_field("change", "positions, weights, sphere, mesh, material, light or environment", "none");
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

uint64_t decoded_bytes(const v1::SceneEdit& message) {
  uint64_t bytes = 0;
  for (const v1::SceneChange& change : message.changes()) bytes += decoded_bytes(change.positions());
  return bytes;
}

}  // namespace diaphane::service

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

/// But positions, which may not be all there.
absl::StatusOr<scene::SceneChange> from_proto(const v1::SceneChange& message) {
  switch (message.change_case()) {
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
    case v1::SceneChange::kPositions:
    case v1::SceneChange::CHANGE_NOT_SET:
      break;
  }
  return base::invalid_field("change", "positions, weights, sphere, mesh, material, light or environment", "none");
}

}  // namespace

absl::StatusOr<EditReader> EditReader::begin(const v1::SceneEdit& message, FindShared find_shared) {
  if (message.changes_size() < 1 || message.changes_size() > kMostChanges) {
    return base::invalid_field("changes", fmt::format("1..{}", kMostChanges), message.changes_size());
  }
  EditReader reader;
  for (int i = 0; i < message.changes_size(); ++i) {
    const v1::SceneChange& change = message.changes(i);
    const auto within = [&](const absl::Status& status) {
      return base::within(fmt::format("changes[{}].", i), status);
    };
    if (!change.has_positions()) {
      absl::StatusOr<scene::SceneChange> read = from_proto(change);
      if (!read.ok()) return within(read.status());
      reader.changes_.push_back(*std::move(read));
      continue;
    }
    absl::StatusOr<PositionsReader> positions = PositionsReader::begin(change.positions(), find_shared);
    if (!positions.ok()) return within(positions.status());
    scene::SceneChange& made = reader.changes_.emplace_back(change.positions().mesh(), scene::PositionsPatch{});
    if (positions->bytes_to_come() == 0) {
      made.patch = positions->finish();
    } else {
      reader.waiting_.push_back({static_cast<size_t>(i), *std::move(positions)});
    }
  }
  return reader;
}

uint64_t EditReader::bytes_to_come() const {
  uint64_t bytes = 0;
  for (size_t i = next_; i < waiting_.size(); ++i) bytes += waiting_[i].reader.bytes_to_come();
  return bytes;
}

absl::Status EditReader::add(std::string_view payload) {
  auto& [change, reader] = waiting_[next_];
  if (absl::Status added = reader.add(payload); !added.ok()) {
    return base::within(fmt::format("changes[{}].", change), added);
  }
  if (reader.bytes_to_come() > 0) return absl::OkStatus();
  changes_[change].patch = reader.finish();
  ++next_;
  return absl::OkStatus();
}

uint64_t decoded_bytes(const v1::SceneEdit& message) {
  uint64_t bytes = 0;
  for (const v1::SceneChange& change : message.changes()) bytes += decoded_bytes(change.positions());
  return bytes;
}

}  // namespace diaphane::service

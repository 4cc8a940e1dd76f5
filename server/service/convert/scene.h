#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene.pb.h"
#include "google/protobuf/field_mask.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// Every value of a new scene.
absl::StatusOr<scene::ScenePatch> from_proto(const v1::Scene& message);

/// The values of `message` that `mask` names: display_name, millimetres_per_unit.
absl::StatusOr<scene::ScenePatch> from_proto(const v1::Scene& message, const google::protobuf::FieldMask& mask);

void to_proto(const scene::SnapshotPtr& scene, v1::Scene& message);

}  // namespace diaphane::service

#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/light.pb.h"
#include "diaphane/v1/scene_service.pb.h"
#include "google/protobuf/field_mask.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

absl::StatusOr<scene::LightKind> from_proto(const v1::Light& message);

/// The values of `message` that `mask` names: the whole light by the name of its kind, or point.position,
/// point.intensity.
absl::StatusOr<scene::LightPatch> from_proto(const v1::Light& message, const google::protobuf::FieldMask& mask);

void to_proto(const scene::Light& light, v1::Light& message);
void to_proto(const scene::Changed<scene::Light>& changed, v1::LightResponse& message);

}  // namespace diaphane::service

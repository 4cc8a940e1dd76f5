#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/material.pb.h"
#include "diaphane/v1/scene_service.pb.h"
#include "google/protobuf/field_mask.pb.h"
#include "optics/presets.h"
#include "scene/scene_store.h"

namespace diaphane::service {

absl::StatusOr<scene::MaterialModel> from_proto(const v1::Material& message);

/// OK when `mask` names the model, in one of its three ways.
absl::Status check_material_mask(const google::protobuf::FieldMask& mask);

void to_proto(const scene::Material& material, v1::Material& message);
void to_proto(const scene::Changed<scene::Material>& changed, v1::MaterialResponse& message);
void to_proto(const optics::MaterialPreset& preset, v1::MaterialPreset& message);

}  // namespace diaphane::service

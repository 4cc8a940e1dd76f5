#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/material.pb.h"
#include "diaphane/v1/scene_service.pb.h"
#include "optics/presets.h"
#include "scene/scene_store.h"

namespace diaphane::service {

absl::StatusOr<scene::NewMaterial> from_proto(const v1::Material& message);

/// What the mask names: the model (as that, or as one of its forms), profile, coat, textures.
absl::StatusOr<scene::MaterialPatch> from_proto(const v1::UpdateMaterialRequest& message);

void to_proto(const scene::Material& material, v1::Material& message);
void to_proto(const scene::Changed<scene::Material>& changed, v1::MaterialResponse& message);
void to_proto(const optics::MaterialPreset& preset, v1::MaterialPreset& message);

}  // namespace diaphane::service

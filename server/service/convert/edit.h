// Edits of a scene.
#pragma once

#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// The changes of an edit, in order. Errors name the field, from "changes[i]" on.
absl::StatusOr<std::vector<scene::SceneChange>> from_proto(const v1::SceneEdit& message);

/// What from_proto() takes at most for what is compressed.
uint64_t decoded_bytes(const v1::SceneEdit& message);

}  // namespace diaphane::service

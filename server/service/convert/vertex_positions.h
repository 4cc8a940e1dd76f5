// Positions of vertices as edits carry them.
#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// Plain, quantised or compressed. What is decoded is bounded by the bytes that came. Errors name the field, from
/// "positions" on.
absl::StatusOr<scene::PositionsPatch> from_proto(const v1::VertexPositions& message);

}  // namespace diaphane::service

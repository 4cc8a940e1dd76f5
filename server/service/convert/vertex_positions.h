// Positions of vertices as edits carry them.
#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// Plain, quantised or compressed. What is decoded is bounded by the bytes that came, and by decoded_bytes(). Errors
/// name the field, from "positions" on.
absl::StatusOr<scene::PositionsPatch> from_proto(const v1::VertexPositions& message);

/// What from_proto() takes at most to decode compressed positions; 0 for what it refuses before.
uint64_t decoded_bytes(const v1::VertexPositions& message);

}  // namespace diaphane::service

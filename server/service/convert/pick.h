// Questions of what lies under a pixel.
#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/render_service.pb.h"
#include "scene/pick.h"

namespace diaphane::service {

struct PickQuery {
  scene::Camera camera;
  glm::uvec2 size_px{1};
  glm::vec2 pixel{0};
};

/// All of `message` but the scene. Errors: INVALID_ARGUMENT for the camera, the size, or a pixel outside of it.
absl::StatusOr<PickQuery> from_proto(const v1::PickRequest& message, uint64_t max_pixels);

void to_proto(const scene::Picked& picked, v1::PickedPoint& message);

}  // namespace diaphane::service

// Views of a stream of frames.
#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/render_service.pb.h"
#include "session/frame_job.h"
#include "session/frame_pace.h"

namespace diaphane::service {

struct StreamView {
  uint64_t sequence = 0;
  session::FrameTask moving;  ///< without a scene
  bool lossless_at_rest = false;
  uint64_t min_revision = 0;
  session::PaceAim aim;
};

/// Errors name the field, from "view" on.
absl::StatusOr<StreamView> from_proto(const v1::StreamView& message, uint64_t max_pixels);

}  // namespace diaphane::service

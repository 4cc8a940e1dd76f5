#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/frame.pb.h"
#include "diaphane/v1/render_service.pb.h"
#include "encode/encode.h"
#include "render/frame.h"
#include "session/frame_job.h"

namespace diaphane::service {

absl::StatusOr<scene::Camera> from_proto(const v1::Camera& message);
absl::StatusOr<render::RenderSettings> from_proto(const v1::RenderSettings& message);
absl::StatusOr<encode::Encoding> from_proto(const v1::Encoding& message);

/// Of a frame by the reference technique, which takes seconds as it is.
inline constexpr uint64_t kMaxReferencePixels = uint64_t{1} << 20;

/// What a frame tells beside its colour. Errors: INVALID_ARGUMENT for an unknown channel, one given twice, or any of a
/// format other than EXR.
absl::StatusOr<std::vector<render::Channel>> channels_from_proto(const v1::Encoding& message);

/// OK when each side is 1..8192 and the product at most `max_pixels`.
absl::Status check_size(const v1::Size& message, uint64_t max_pixels);

/// All of `message` but the scene; no deadline, no answer yet.
absl::StatusOr<session::FrameTask> from_proto(const v1::RenderFrameRequest& message, uint64_t max_pixels);

void to_proto(session::EncodedFrame frame, v1::RenderFrameResponse& message);

}  // namespace diaphane::service

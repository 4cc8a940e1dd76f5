#pragma once

#include "absl/status/statusor.h"
#include "encode/encode.h"
#include "render/frame.h"
#include "session/frame_job.h"

namespace diaphane::session {

/// Encodes `frame` and adds the stage "encode"; of H.264 it moves the pixels on. The rest of the frame stays, so that
/// its memory can be used again. INTERNAL when its pixels are not of the format's kind. Thread-safe.
absl::StatusOr<EncodedFrame> encode_frame(render::Frame& frame, const encode::Encoding& encoding);

/// Milliseconds since `start`.
double milliseconds_since(absl::Time start);

}  // namespace diaphane::session

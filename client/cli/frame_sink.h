// Where streamed frames go.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "diaphane/stream.h"

namespace diaphane::cli {

/// Frames in order, one thread at a time.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual absl::Status add(const StreamedFrame& frame) = 0;
  /// Errors: kExitFile what was added cannot be written.
  virtual absl::Status finish() { return absl::OkStatus(); }
};

/// By `output`: "-" is stdout, and .h264 a file, for bare frames one behind the other; .mp4 a movie of
/// `frames_per_second` (of JPEG frames); else a folder of pictures, which it makes.
///
/// Errors: kExitFile it cannot be written; kExitUsage frames of that format do not go there.
absl::StatusOr<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& output, ImageFormat format,
                                                           const Size& size, double frames_per_second);

}  // namespace diaphane::cli

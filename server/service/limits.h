#pragma once

#include <cstdint>

#include "absl/time/time.h"
#include "scene/limits.h"

namespace diaphane::service {

/// What the services accept at most.
struct ServiceLimits {
  scene::SceneLimits scene;
  uint64_t max_pixels = 33'554'432;                        ///< of a frame; 8K fits
  uint32_t max_queued_frames = 32;                         ///< that wait for the render thread
  absl::Duration max_reference_time = absl::Seconds(600);  ///< that a frame by the reference technique is drawn for
  uint32_t max_remembered_replies = 4096;
  /// An upload that sends nothing for so long is ended: what it reserved is for others.
  absl::Duration max_upload_silence = absl::Seconds(30);
};

inline constexpr uint32_t kMaxChunkBytes = 1u << 20;

}  // namespace diaphane::service

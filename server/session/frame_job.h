// A frame that somebody waits for.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "encode/encode.h"
#include "render/frame.h"

namespace diaphane::session {

/// A frame as it goes to a client.
struct EncodedFrame {
  std::string bytes;
  std::string_view content_type;
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  uint64_t scene_revision = 0;
  std::vector<render::StageTime> stages;  ///< "queue", the renderer's, "encode"
  std::string path;
};

/// What a frame is asked with.
struct FrameTask {
  render::FrameRequest request;  ///< `format` is set from `encoding`
  encode::Encoding encoding;
  absl::Time deadline = absl::InfiniteFuture();
  /// Called exactly once, on whatever thread ends the job. It must not block.
  std::function<void(absl::StatusOr<EncodedFrame>)> done;
};

/// A task on its way. Thread-safe.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)) {}

  const render::FrameRequest& request() const { return task_.request; }
  const encode::Encoding& encoding() const { return task_.encoding; }
  absl::Time deadline() const { return task_.deadline; }
  absl::Time submitted() const { return submitted_; }

  /// Once set, stays set; the renderer stops when it sees it.
  const std::atomic<bool>& cancelled() const { return cancelled_; }
  void cancel() { cancelled_ = true; }

  /// The first call is the answer; later ones are dropped.
  void finish(absl::StatusOr<EncodedFrame> result) {
    if (finished_.exchange(true)) return;
    // What `done` keeps alive goes with it.
    const auto done = std::move(task_.done);
    done(std::move(result));
  }

 private:
  FrameTask task_;
  const absl::Time submitted_ = absl::Now();
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> finished_{false};
};

}  // namespace diaphane::session

// A frame that somebody waits for.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "base/status.h"
#include "encode/encode.h"
#include "fmt/format.h"
#include "render/frame.h"

namespace diaphane::session {

/// A frame as it goes to a client.
struct EncodedFrame {
  std::string bytes;
  base::Image8 pixels{};  ///< of H.264, in place of bytes: whoever has the frames before encodes it
  std::string_view content_type;
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  uint64_t scene_revision = 0;
  std::vector<render::StageTime> stages;  ///< "queue", the renderer's, "encode"
  std::string path;
  float exposure_ev = 0;  ///< as render::Frame has it
};

/// What a frame is asked with.
struct FrameTask {
  render::FrameRequest request;  ///< `format` is set from `encoding`
  encode::Encoding encoding;
  absl::Time deadline = absl::InfiniteFuture();
  /// How long it may take from when the renderer begins; then it ends with DEADLINE_EXCEEDED, naming `limit_field`.
  absl::Duration time_limit = absl::InfiniteDuration();
  std::string_view limit_field;
  /// Where given, called on the render thread as the frame's turn comes; may change the request and the encoding.
  /// False: the frame is not wanted any more, and ends with CANCELLED. It must be quick.
  std::function<bool(render::FrameRequest&, encode::Encoding&)> latest{};
  /// Where given, called on another thread once the renderer has begun, while the frame is drawn or later. It must not
  /// block.
  std::function<void()> begun{};
  /// Called exactly once, on whatever thread ends the job. It must not block.
  std::function<void(absl::StatusOr<EncodedFrame>)> done;
};

/// A task on its way. Thread-safe.
class FrameJob {
 public:
  explicit FrameJob(FrameTask task) : task_(std::move(task)), scene_(task_.request.scene->name) {}

  const render::FrameRequest& request() const { return task_.request; }
  const encode::Encoding& encoding() const { return task_.encoding; }
  /// Its name, which no choose() changes.
  const std::string& scene() const { return scene_; }
  absl::Time submitted() const { return submitted_; }

  /// The renderer begins. Once, before expires() is asked from another thread, which the caller sees to.
  void begin() { limit_ = absl::Now() + task_.time_limit; }
  /// When it ends unfinished: at its deadline, or at its limit once it has begun.
  absl::Time expires() const { return std::min(task_.deadline, limit_); }
  /// What it ends with then.
  absl::Status expired() const {
    if (task_.deadline <= limit_) return absl::DeadlineExceededError("the frame's deadline passed");
    return base::field_error(
        absl::StatusCode::kDeadlineExceeded,
        {std::string(task_.limit_field), "more", fmt::format("at most {}", absl::ToDoubleSeconds(task_.time_limit))});
  }

  /// The task's latest(), by the thread that draws, before the request is read. Fits the pixels to the encoding.
  bool choose() {
    if (task_.latest != nullptr && !task_.latest(task_.request, task_.encoding)) return false;
    task_.request.format = task_.encoding.format == encode::ImageFormat::kExr ? render::PixelFormat::kLinearFloat
                                                                              : render::PixelFormat::kSrgb8;
    return true;
  }

  bool tells_begun() const { return task_.begun != nullptr; }
  void tell_begun() const { task_.begun(); }

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
  const std::string scene_;
  const absl::Time submitted_ = absl::Now();
  absl::Time limit_ = absl::InfiniteFuture();
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> finished_{false};
};

}  // namespace diaphane::session

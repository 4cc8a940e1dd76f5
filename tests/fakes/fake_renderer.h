// A FrameRenderer without GL, which a test can hold up.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "render/channels.h"
#include "render/frame.h"
#include "session/render_thread.h"

namespace diaphane::fakes {

/// What a test and its renderers share. Thread-safe.
class RendererControl {
 public:
  /// Frames that start from now on wait for release(), or for their cancellation where the renderer sees it.
  void hold() { set(&held_, true); }
  void release() { set(&held_, false); }
  /// The renderer does not look at the flag, as a driver in the middle of a draw does not.
  void ignore_cancellation() { set(&deaf_, true); }
  /// The next frame throws std::bad_alloc.
  void run_out_of_memory() { set(&out_of_memory_, true); }

  /// What the next frames say of their progress, one after the other, before they are held.
  void tell(std::vector<double> shares) {
    absl::MutexLock lock(&mutex_);
    shares_ = std::move(shares);
  }
  std::vector<double> shares() {
    absl::MutexLock lock(&mutex_);
    return shares_;
  }

  /// Blocks until `count` frames have started.
  void wait_for_started(int count) {
    const auto reached = [&] { return started_ >= count; };
    absl::MutexLock lock(&mutex_, absl::Condition(&reached));
  }
  int started() {
    absl::MutexLock lock(&mutex_);
    return started_;
  }

  /// Pixels of the frames that came back.
  std::vector<base::Image8> recycled() {
    absl::MutexLock lock(&mutex_);
    return recycled_;
  }
  void recycle(base::Image8 image) {
    absl::MutexLock lock(&mutex_);
    recycled_.push_back(std::move(image));
  }

  /// Called by the renderer. False: the frame was cancelled.
  bool pass(const std::atomic<bool>& cancelled) {
    absl::MutexLock lock(&mutex_);
    ++started_;
    if (std::exchange(out_of_memory_, false)) throw std::bad_alloc();
    while (held_ && (deaf_ || !cancelled)) changed_.WaitWithTimeout(&mutex_, absl::Milliseconds(1));
    return deaf_ || !cancelled;
  }

 private:
  void set(bool* what, bool value) {
    absl::MutexLock lock(&mutex_);
    *what = value;
    changed_.SignalAll();
  }

  absl::Mutex mutex_;
  absl::CondVar changed_;
  bool held_ = false;
  bool deaf_ = false;
  bool out_of_memory_ = false;
  std::vector<double> shares_;
  std::vector<base::Image8> recycled_;
  int started_ = 0;
};

/// Every pixel tells the scene's revision: (revision, width, height, 255) modulo 256, or the same as floats and then
/// the number of each extra channel.
class FakeRenderer : public render::FrameRenderer {
 public:
  explicit FakeRenderer(std::shared_ptr<RendererControl> control) : control_(std::move(control)) {}

  absl::StatusOr<render::Frame> render(const render::FrameRequest& request,
                                       const std::atomic<bool>& cancelled) override {
    for (const double share : control_->shares()) {
      if (request.progress) request.progress(share);
    }
    if (!control_->pass(cancelled)) return absl::CancelledError("seen by the renderer");
    render::Frame frame;
    frame.scene_revision = request.scene->revision;
    frame.stages = {{"shade", 0.5, true}, {"atlas", 0, false}};
    frame.path = "fake";
    const size_t pixels = size_t{request.width_px} * request.height_px;
    const uint64_t values[] = {request.scene->revision, request.width_px, request.height_px, 255};
    if (request.format == render::PixelFormat::kSrgb8) {
      base::Image8 image{request.width_px, request.height_px, {}};
      for (size_t i = 0; i < 4 * pixels; ++i) image.rgba.push_back(static_cast<uint8_t>(values[i % 4]));
      frame.image = std::move(image);
    } else {
      base::ImageF image{request.width_px, request.height_px, render::channel_names(request.channels), {}};
      const size_t channels = image.channels.size();
      for (size_t i = 0; i < channels * pixels; ++i) {
        const size_t channel = i % channels;
        image.values.push_back(static_cast<float>(channel < 4 ? values[channel] : channel));
      }
      frame.image = std::move(image);
    }
    return frame;
  }

  void recycle(render::Frame frame) override {
    if (auto* image = std::get_if<base::Image8>(&frame.image)) control_->recycle(std::move(*image));
  }

  render::RendererInfo info() const override { return {"fake renderer", "us", "0", true, "a test asked for it"}; }

 private:
  std::shared_ptr<RendererControl> control_;
};

inline session::RendererFactory fake_renderers(std::shared_ptr<RendererControl> control) {
  return [control = std::move(control)]() -> absl::StatusOr<std::unique_ptr<render::FrameRenderer>> {
    return std::make_unique<FakeRenderer>(control);
  };
}

}  // namespace diaphane::fakes

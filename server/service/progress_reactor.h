// A frame and the way to it, as a stream.
#pragma once

#include <memory>
#include <optional>

#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "diaphane/v1/render_service.pb.h"
#include "grpcpp/support/server_callback.h"
#include "session/render_thread.h"

namespace diaphane::service {

/// One call of RenderFrameWithProgress. Finishes exactly once: with the frame, its error, or the call's cancellation,
/// which also ends the job. Deletes itself.
class ProgressReactor final : public grpc::ServerWriteReactor<v1::RenderFrameWithProgressResponse> {
 public:
  ProgressReactor(session::RenderThread& render_thread, session::FrameTask task);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  /// By which the renderer's threads reach a reactor that may be gone. `mutex` guards all of the reactor, too.
  struct Link {
    absl::Mutex mutex;
    ProgressReactor* reactor;  ///< null once it is gone
  };

  // These need the mutex.
  void report(double share);
  void end(absl::StatusOr<session::EncodedFrame> result);
  void write_progress(double share);
  void advance();
  void finish(const absl::Status& status);

  void stop();

  session::RenderThread& render_thread_;
  const std::shared_ptr<Link> link_ = std::make_shared<Link>();
  // Not an owner: a frame that waits for a slow client must not keep its scene alive.
  std::weak_ptr<session::FrameJob> job_;
  v1::RenderFrameWithProgressResponse message_;
  std::optional<absl::StatusOr<session::EncodedFrame>> result_;
  double told_ = -1;
  absl::Time told_at_ = absl::InfinitePast();
  bool writing_ = false;
  bool finished_ = false;
};

}  // namespace diaphane::service

// The thread that draws, and the queue before it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "base/worker_pool.h"
#include "render/frame.h"
#include "session/fair_shares.h"
#include "session/frame_job.h"

namespace diaphane::session {

/// Makes the renderer on the thread that will use it.
using RendererFactory = std::function<absl::StatusOr<std::unique_ptr<render::FrameRenderer>>()>;

struct RenderThreadOptions {
  size_t max_queued_frames = 32;  ///< that wait to be drawn; at least 1
  size_t encode_threads = 2;      ///< at least 1
  /// Frames drawn and not yet encoded. At so many the next frame waits, so that pixels do not pile up. At least 1.
  size_t max_encoding_frames = 4;
};

/// Owns a renderer, the one thread that may call it, and threads that encode what it drew. Scenes get equal shares of
/// the renderer's time; the jobs of one are drawn in the order in which they came. Thread-safe.
class RenderThread {
 public:
  /// Returns when the renderer is made, or the factory's error.
  static absl::StatusOr<std::unique_ptr<RenderThread>> start(const RenderThreadOptions& options,
                                                             const RendererFactory& make_renderer);

  /// stop(absl::InfinitePast()).
  ~RenderThread();

  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// RESOURCE_EXHAUSTED when the queue is full, UNAVAILABLE once stop() was called; then `done` is never called. Else
  /// it is, exactly once: with the frame, the renderer's error, CANCELLED, DEADLINE_EXCEEDED at the task's deadline or
  /// time limit, or UNAVAILABLE from stop().
  absl::StatusOr<std::shared_ptr<FrameJob>> submit(FrameTask task) ABSL_LOCKS_EXCLUDED(mutex_);

  /// Ends `job` with CANCELLED before it returns, wherever it is; nothing when it has ended.
  void cancel(const std::shared_ptr<FrameJob>& job) ABSL_LOCKS_EXCLUDED(mutex_);

  /// Takes back pixels that an EncodedFrame came with: a later frame is made in their memory.
  void recycle(base::Image8 pixels) ABSL_LOCKS_EXCLUDED(mutex_);

  /// Takes no more jobs, lets those at hand end until `deadline`, ends the rest with UNAVAILABLE, and joins the
  /// threads: at most one frame past the deadline, where the renderer does not see the cancellation sooner. Once.
  void stop(absl::Time deadline) ABSL_LOCKS_EXCLUDED(mutex_);

  const render::RendererInfo& info() const { return info_; }

  /// Whether frames wait, or are drawn or encoded.
  bool is_busy() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  using JobPtr = std::shared_ptr<FrameJob>;
  struct Drawn {
    JobPtr job;
    render::Frame frame;
  };

  explicit RenderThread(const RenderThreadOptions& options);

  void run(render::FrameRenderer& renderer);
  /// Keeps what is worth it for the renderer.
  void keep(render::Frame frame) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void recycle_spent(render::FrameRenderer& renderer) ABSL_LOCKS_EXCLUDED(mutex_);
  /// Waits for the next job to draw; null when it is time to end.
  JobPtr next_job() ABSL_LOCKS_EXCLUDED(mutex_);
  void draw(render::FrameRenderer& renderer, const JobPtr& job);
  /// The first of drawn_.
  void encode_next() ABSL_LOCKS_EXCLUDED(mutex_);
  /// Ends a job that was drawn.
  void end(const JobPtr& job, absl::StatusOr<EncodedFrame> result) ABSL_LOCKS_EXCLUDED(mutex_);
  /// Tells jobs that they have begun, and ends them at their deadlines.
  void watch() ABSL_LOCKS_EXCLUDED(mutex_);

  /// Frames that are drawn or encoded.
  size_t most_at_once() const { return options_.max_encoding_frames + 1; }

  const RenderThreadOptions options_;
  render::RendererInfo info_;

  mutable absl::Mutex mutex_;
  // One for each thread that waits, so that a frame does not wake those that have nothing to do.
  absl::CondVar can_draw_;    // the render thread: a job came, or a frame was encoded
  absl::CondVar must_watch_;  // the watching thread: a job has begun to tell of, or has a time to end at
  absl::CondVar fewer_;       // stop(): jobs ended
  std::vector<JobPtr> queued_ ABSL_GUARDED_BY(mutex_);
  FairShares shares_ ABSL_GUARDED_BY(mutex_);
  std::vector<JobPtr> started_ ABSL_GUARDED_BY(mutex_);       // drawn or encoded right now, and wanted
  std::vector<JobPtr> begun_ ABSL_GUARDED_BY(mutex_);         // and not told so
  std::vector<Drawn> drawn_ ABSL_GUARDED_BY(mutex_);          // and not being encoded, oldest first
  size_t encoding_ ABSL_GUARDED_BY(mutex_) = 0;               // frames, wanted or not
  std::vector<render::Frame> spent_ ABSL_GUARDED_BY(mutex_);  // that the renderer may use again
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;             // no more jobs come
  bool quit_ ABSL_GUARDED_BY(mutex_) = false;                 // threads end

  std::vector<const std::string*> waiting_scenes_;  // of queued_, by the render thread
  std::unique_ptr<base::WorkerPool> encoders_;
  std::thread render_thread_;
  std::thread watching_thread_;
};

}  // namespace diaphane::session

// Frames as a scene changes, as a stream.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "base/worker_pool.h"
#include "diaphane/v1/render_service.grpc.pb.h"
#include "encode/h264.h"
#include "grpcpp/alarm.h"
#include "scene/scene_store.h"
#include "service/convert/stream.h"
#include "service/limits.h"
#include "service/open_streams.h"
#include "session/frame_pace.h"
#include "session/render_thread.h"

namespace diaphane::service {

/// One call of StreamFrames. At most three frames of it are on their way: one waits, and shows what is newest when its
/// turn comes, one is drawn, one is encoded. Of what waits to be written only the newest is kept; of video, and with
/// every revision, all in order. Finishes exactly once: at the client's end, its cancellation, or an error. Deletes
/// itself.
class FrameStream final : public grpc::ServerBidiReactor<v1::StreamFramesRequest, v1::StreamFramesResponse> {
 public:
  FrameStream(scene::SceneStore& store, session::RenderThread& render_thread, base::WorkerPool& video,
              const ServiceLimits& limits, OpenStreams& open_streams);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  /// By which others reach a reactor that may be gone.
  struct Link {
    absl::Mutex mutex;
    FrameStream* reactor ABSL_GUARDED_BY(mutex);  ///< null once it is gone
    std::optional<grpc::Alarm> alarm ABSL_GUARDED_BY(mutex);
  };
  /// A frame while things change, then one as it was asked for, then a lossless one.
  enum class Rest { kMoving, kSharp, kLossless };
  /// What a frame shows; revisions and views only grow.
  struct Shown {
    uint64_t revision = 0;
    uint64_t view_sequence = 0;
    Rest rest = Rest::kMoving;
    auto operator<=>(const Shown&) const = default;
  };
  struct Flight {
    Rest rest = Rest::kMoving;
    absl::Time began;
    std::optional<Shown> shown{};  ///< once it is being drawn
    bool reduced = false;
    std::weak_ptr<session::FrameJob> job{};
    std::optional<session::EncodedFrame> frame{};  ///< once it is made
    encode::H264Options video{};                   ///< where that is pixels
    bool key_frame = false;
  };
  using FlightPtr = std::shared_ptr<Flight>;

  absl::Status take(const v1::StreamFramesRequest& request);
  absl::Status open(const v1::StreamOpening& opening);
  void cancel_flights();

  // These need the link's mutex.
  absl::Status take_view(const v1::StreamView& message);
  absl::Status take_credits(uint32_t credits);
  void see(const scene::SnapshotPtr& snapshot);
  bool shows(const scene::SceneSnapshot& snapshot) const;
  /// The snapshot to show next; null while there is none.
  scene::SnapshotPtr next_snapshot() const;
  std::optional<Shown> wanted() const;
  void advance();
  void advance_at_rest();
  void start(Rest rest);
  bool choose(Flight& flight, render::FrameRequest& request, encode::Encoding& encoding);
  void end(const FlightPtr& flight, absl::StatusOr<session::EncodedFrame> frame);
  void encode_next();
  void encoded(absl::StatusOr<encode::H264Frame> frame, double milliseconds);
  void write_next();
  void wake_at(absl::Time due);
  void at_alarm();
  void finish(const absl::Status& status);

  scene::SceneStore& store_;
  session::RenderThread& render_thread_;
  base::WorkerPool& video_;
  const ServiceLimits& limits_;
  OpenStreams& open_streams_;
  uint64_t id_ = 0;  ///< in open_streams_
  const std::shared_ptr<Link> link_ = std::make_shared<Link>();

  v1::StreamFramesRequest request_;
  v1::StreamFramesResponse message_;
  std::shared_ptr<const scene::SceneStore::Watcher> watch_;
  scene::SnapshotPtr snapshot_;
  std::optional<StreamView> view_;
  bool every_revision_ = false;
  std::deque<scene::SnapshotPtr> revisions_;  ///< where every one is wanted: those to be drawn
  uint32_t credits_ = 0;
  std::vector<FlightPtr> flights_;                ///< in the order in which they began
  std::deque<FlightPtr> drawn_;                   ///< where all are sent, in order: wait to be encoded as video
  std::deque<FlightPtr> ready_;                   ///< wait to be written
  std::shared_ptr<encode::H264Encoder> encoder_;  ///< once a view asked for one; all frames are sent from then on
  bool encoding_ = false;                         ///< the first of drawn_
  bool key_frame_wanted_ = false;
  Shown begun_;  ///< the newest that was ever drawn
  bool begun_reduced_ = false;
  Shown sent_;  ///< the newest that was ever written
  session::FramePace pace_;
  absl::Time changed_at_ = absl::InfinitePast();
  absl::Time written_at_ = absl::Now();
  absl::Time wakes_at_ = absl::InfiniteFuture();
  std::optional<absl::Status> ending_;
  bool writing_ = false;
  bool closing_ = false;  ///< nothing new begins
  bool finished_ = false;
};

}  // namespace diaphane::service

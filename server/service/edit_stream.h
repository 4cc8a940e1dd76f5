// Live changes of a scene, as a stream.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "diaphane/v1/scene_service.grpc.pb.h"
#include "grpcpp/alarm.h"
#include "scene/scene_store.h"
#include "service/convert/edit.h"
#include "service/editors.h"
#include "service/open_streams.h"
#include "service/shared_buffers.h"
#include "session/edit_pace.h"
#include "session/render_thread.h"

namespace diaphane::service {

/// One call of EditScene. Edits are applied on the reading thread, one after the other: a client that sends faster is
/// held back by its own stream, sooner while frames are drawn (session::EditPace). Finishes exactly once. Deletes
/// itself.
class EditStream final : public grpc::ServerBidiReactor<v1::EditSceneRequest, v1::EditSceneResponse> {
 public:
  /// `peer` as gRPC names it.
  EditStream(scene::SceneStore& store, const session::RenderThread& render_thread, Editors& editors,
             OpenStreams& open_streams, SharedBufferCount& shared_buffers, std::string_view peer);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  /// By which an alarm reaches a stream that may be gone.
  struct Link {
    absl::Mutex mutex;
    EditStream* stream ABSL_GUARDED_BY(mutex);  ///< null once it is gone
    std::optional<grpc::Alarm> alarm ABSL_GUARDED_BY(mutex);
  };

  absl::Status take(const v1::EditSceneRequest& request);
  absl::Status open(const v1::EditOpening& opening);
  absl::Status begin(const v1::SceneEdit& edit);
  absl::Status share(uint64_t bytes);
  absl::Status take_payload(const std::string& bytes);
  /// What has come whole.
  absl::Status apply();
  /// At once, or when it is time.
  void read_next();
  void go_on();
  void acknowledge() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void finish(const absl::Status& status) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  scene::SceneStore& store_;
  const session::RenderThread& render_thread_;
  Editors& editors_;
  OpenStreams& open_streams_;
  uint64_t id_ = 0;  ///< in open_streams_
  // Of the reading thread.
  v1::EditSceneRequest request_;
  std::string scene_;
  std::shared_ptr<Editor> editor_;
  uint64_t turn_ = 0;                 ///< of this stream among the editor's
  std::optional<uint64_t> sequence_;  ///< of the last edit
  struct Edit {
    uint64_t sequence;
    scene::Reservation memory;
    EditReader reader;
  };
  std::optional<Edit> edit_;  ///< whose payload has not come whole
  SharedBuffers shared_buffers_;
  session::EditPace pace_;
  absl::Duration work_;  ///< that the edit took which is read now
  const std::shared_ptr<Link> link_ = std::make_shared<Link>();

  absl::Mutex mutex_;
  v1::EditSceneResponse applied_ ABSL_GUARDED_BY(mutex_);
  std::vector<v1::SharedMemory> offers_ ABSL_GUARDED_BY(mutex_);  ///< not told
  v1::EditSceneResponse message_;                                 ///< being written
  uint64_t told_ ABSL_GUARDED_BY(mutex_) = 0;                     ///< revision
  bool writing_ ABSL_GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> ending_ ABSL_GUARDED_BY(mutex_);
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace diaphane::service

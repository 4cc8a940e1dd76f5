#include <mutex>
#include <optional>
#include <utility>

#include "connection.h"
#include "convert.h"
#include "diaphane/scene.h"
#include "diaphane/stream.h"
#include "reopening.h"

namespace diaphane {

using internal::from_proto;
using internal::to_proto;

class FrameStream::Impl {
 public:
  Impl(std::shared_ptr<internal::Connection> connection, std::string scene, const StreamOptions& options)
      : connection_(std::move(connection)),
        reopening_(connection_->options()),
        scene_(std::move(scene)),
        frames_in_flight_(options.frames_in_flight),
        every_revision_(options.every_revision) {
    set_view(options.view);
  }

  ~Impl() {
    close();
    if (stream_ != nullptr) stream_->Finish();
  }

  uint64_t set_view(const StreamView& view) {
    const std::lock_guard lock(mutex_);
    RenderOptions moving{view.camera, view.size, view.settings, view.moving};
    moving.quality = view.quality;
    v1::RenderFrameRequest request = to_proto(moving);
    view_.set_sequence(view_.sequence() + 1);
    *view_.mutable_camera() = std::move(*request.mutable_camera());
    *view_.mutable_size() = std::move(*request.mutable_size());
    *view_.mutable_settings() = std::move(*request.mutable_settings());
    *view_.mutable_moving() = std::move(*request.mutable_encoding());
    view_.mutable_moving()->set_bits_per_second(view.bits_per_second);
    view_.set_lossless_at_rest(view.lossless_at_rest);
    view_.set_min_revision(view.min_revision);
    view_.set_frames_per_second(view.frames_per_second);
    view_.set_bytes_per_second(view.bytes_per_second);
    if (stream_ != nullptr) {
      v1::StreamFramesRequest part;
      *part.mutable_view() = view_;
      stream_->Write(part);
    }
    return view_.sequence();
  }

  absl::StatusOr<StreamedFrame> next() {
    while (true) {
      if (absl::Status opened = open(); !opened.ok()) return opened;
      if (frames_in_flight_ == 0 && !asked_) grant_one();
      asked_ = true;
      v1::StreamFramesResponse response;
      while (stream_->Read(&response)) {
        reopening_.succeeded();
        if (!response.has_frame()) continue;
        came_ = true;
        asked_ = false;
        if (frames_in_flight_ > 0) grant_one();
        v1::StreamedFrame& frame = *response.mutable_frame();
        return StreamedFrame{from_proto(std::move(*frame.mutable_frame())), frame.view_sequence(), frame.at_rest(),
                             frame.reduced(), frame.key_frame()};
      }
      const absl::Status ended = finish();
      if (every_revision_ && came_) return ended;
      if (absl::Status again = reopening_.wait_after(ended); !again.ok()) return again;
    }
  }

  void request_key_frame() {
    v1::StreamFramesRequest part;
    part.mutable_key_frame();
    const std::lock_guard lock(mutex_);
    if (stream_ != nullptr) stream_->Write(part);
  }

  void close() {
    reopening_.stop();
    const std::lock_guard lock(mutex_);
    if (context_.has_value()) context_->TryCancel();
  }

 private:
  absl::Status open() {
    const std::lock_guard lock(mutex_);
    if (reopening_.stopped()) return absl::CancelledError("the stream was closed");
    if (stream_ != nullptr) return absl::OkStatus();
    context_.emplace();
    stream_ = connection_->render_service()->StreamFrames(&*context_);
    v1::StreamFramesRequest part;
    part.mutable_opening()->set_scene(scene_);
    *part.mutable_opening()->mutable_view() = view_;
    part.mutable_opening()->set_credits(frames_in_flight_);
    asked_ = false;
    part.mutable_opening()->set_every_revision(every_revision_);
    stream_->Write(part);
    return absl::OkStatus();
  }

  void grant_one() {
    v1::StreamFramesRequest part;
    part.set_credits(1);
    const std::lock_guard lock(mutex_);
    stream_->Write(part);
  }

  absl::Status finish() {
    const std::lock_guard lock(mutex_);
    const grpc::Status status = stream_->Finish();
    stream_.reset();
    return internal::to_absl(status);
  }

  const std::shared_ptr<internal::Connection> connection_;
  internal::Reopening reopening_;
  const std::string scene_;
  const uint32_t frames_in_flight_;
  const bool every_revision_;
  bool came_ = false;   // a frame
  bool asked_ = false;  // for the one that next() waits for, where none are in flight
  std::mutex mutex_;    // of what is written, and of the pointers; reading needs none
  v1::StreamView view_;
  std::optional<grpc::ClientContext> context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::StreamFramesRequest, v1::StreamFramesResponse>> stream_;
};

FrameStream::FrameStream(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameStream::FrameStream(FrameStream&&) noexcept = default;
FrameStream& FrameStream::operator=(FrameStream&&) noexcept = default;
FrameStream::~FrameStream() = default;
absl::StatusOr<StreamedFrame> FrameStream::next() { return impl_->next(); }
uint64_t FrameStream::set_view(const StreamView& view) { return impl_->set_view(view); }
void FrameStream::request_key_frame() { impl_->request_key_frame(); }
void FrameStream::close() { impl_->close(); }

FrameStream Scene::stream(const StreamOptions& options) const {
  return FrameStream(std::make_unique<FrameStream::Impl>(connection_, name_, options));
}

}  // namespace diaphane

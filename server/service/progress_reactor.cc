#include "service/progress_reactor.h"

#include <utility>

#include "absl/time/clock.h"
#include "service/convert/frame.h"
#include "service/convert/status.h"

namespace diaphane::service {
namespace {

constexpr absl::Duration kPause = absl::Milliseconds(100);  // between two words of progress

}  // namespace

ProgressReactor::ProgressReactor(session::RenderThread& render_thread, session::FrameTask task)
    : render_thread_(render_thread) {
  link_->reactor = this;
  task.request.progress = [link = link_](double share) {
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->report(share);
  };
  task.done = [link = link_](absl::StatusOr<session::EncodedFrame> result) {
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->end(std::move(result));
  };
  // gRPC binds the reactor, and may then cancel it, only after this.
  const auto job = render_thread_.submit(std::move(task));
  if (job.ok()) {
    job_ = *job;
    return;
  }
  const absl::MutexLock lock(&link_->mutex);
  finish(job.status());
}

void ProgressReactor::OnWriteDone(bool ok) {
  if (!ok) return stop();
  const std::shared_ptr<Link> link = link_;
  const absl::MutexLock lock(&link->mutex);
  writing_ = false;
  if (result_.has_value()) advance();
}

void ProgressReactor::OnCancel() { stop(); }

void ProgressReactor::OnDone() {
  {
    const std::shared_ptr<Link> link = link_;
    const absl::MutexLock lock(&link->mutex);
    link->reactor = nullptr;
  }
  delete this;
}

void ProgressReactor::stop() {
  // The job's end takes the mutex.
  if (const auto job = job_.lock()) render_thread_.cancel(job);
  const std::shared_ptr<Link> link = link_;
  const absl::MutexLock lock(&link->mutex);
  finish(absl::CancelledError("cancelled by the caller"));
}

void ProgressReactor::report(double share) {
  if (finished_ || writing_ || result_.has_value() || share <= told_) return;
  if (absl::Now() - told_at_ >= kPause) write_progress(share);
}

void ProgressReactor::end(absl::StatusOr<session::EncodedFrame> result) {
  result_ = std::move(result);
  if (!writing_) advance();
}

void ProgressReactor::write_progress(double share) {
  told_ = share;
  told_at_ = absl::Now();
  message_.set_progress(static_cast<float>(share));
  writing_ = true;
  StartWrite(&message_);
}

void ProgressReactor::advance() {
  if (finished_) return;
  if (!result_->ok()) return finish(result_->status());
  if (told_ < 1) return write_progress(1);
  to_proto(**std::move(result_), *message_.mutable_frame());
  finished_ = true;
  StartWriteAndFinish(&message_, {}, grpc::Status::OK);
}

void ProgressReactor::finish(const absl::Status& status) {
  if (std::exchange(finished_, true)) return;
  Finish(to_grpc(status));
}

}  // namespace diaphane::service

#include "service/frame_stream.h"

#include <algorithm>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/frame.h"
#include "service/convert/status.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kMostCredits = 64;
constexpr size_t kMostFlights = 3;
constexpr absl::Duration kRest = absl::Milliseconds(150);
constexpr absl::Duration kHeartbeat = absl::Seconds(5);
constexpr absl::Duration kRetry = absl::Milliseconds(20);  // when the render queue is full

}  // namespace

FrameStream::FrameStream(scene::SceneStore& store, session::RenderThread& render_thread, const ServiceLimits& limits,
                         OpenStreams& open_streams)
    : store_(store), render_thread_(render_thread), limits_(limits), open_streams_(open_streams) {
  {
    const absl::MutexLock lock(&link_->mutex);
    link_->reactor = this;
    wake_at(written_at_ + kHeartbeat);
  }
  id_ = open_streams_.add([this] {
    const absl::MutexLock lock(&link_->mutex);
    finish(absl::UnavailableError("the server is stopping"));
  });
  StartRead(&request_);
}

void FrameStream::OnReadDone(bool ok) {
  const absl::Status status = ok ? take(request_) : absl::OkStatus();
  if (ok && status.ok()) return StartRead(&request_);
  cancel_flights();
  const absl::MutexLock lock(&link_->mutex);
  finish(status);
}

void FrameStream::OnWriteDone(bool ok) {
  const std::shared_ptr<Link> link = link_;
  const absl::MutexLock lock(&link->mutex);
  writing_ = false;
  if (ending_.has_value() || !ok) return finish(ending_.value_or(absl::CancelledError("the client is gone")));
  write_next();
  advance();
}

void FrameStream::OnCancel() {
  cancel_flights();
  const absl::MutexLock lock(&link_->mutex);
  finish(absl::CancelledError("cancelled by the caller"));
}

void FrameStream::OnDone() {
  open_streams_.remove(id_);
  watch_.reset();
  {
    const std::shared_ptr<Link> link = link_;
    const absl::MutexLock lock(&link->mutex);
    link->reactor = nullptr;
    link->alarm.reset();
  }
  delete this;
}

absl::Status FrameStream::take(const v1::StreamFramesRequest& request) {
  if (request.has_opening()) return open(request.opening());
  if (watch_ == nullptr) return base::invalid_field("part", "an opening first", "none");
  const absl::MutexLock lock(&link_->mutex);
  absl::Status taken = base::invalid_field("part", "a view or credits", "nothing");
  if (request.has_view()) taken = take_view(request.view());
  if (request.part_case() == v1::StreamFramesRequest::kCredits) taken = take_credits(request.credits());
  if (taken.ok()) advance();
  return taken;
}

absl::Status FrameStream::open(const v1::StreamOpening& opening) {
  if (watch_ != nullptr) return base::invalid_field("part", "one opening", "a second");
  {
    const absl::MutexLock lock(&link_->mutex);
    if (absl::Status taken = take_view(opening.view()); !taken.ok()) return taken;
    if (opening.credits() != 0) {
      if (absl::Status taken = take_credits(opening.credits()); !taken.ok()) return taken;
    }
  }
  auto watch = store_.watch({"scene", opening.scene()}, [link = link_](const scene::SnapshotPtr& snapshot) {
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->see(snapshot);
  });
  if (!watch.ok()) return watch.status();
  watch_ = *std::move(watch);
  return absl::OkStatus();
}

absl::Status FrameStream::take_view(const v1::StreamView& message) {
  if (view_.has_value() && message.sequence() <= view_->sequence) {
    return base::invalid_field("view.sequence", fmt::format("above {}", view_->sequence),
                               static_cast<double>(message.sequence()));
  }
  absl::StatusOr<StreamView> view = from_proto(message, limits_.max_pixels);
  if (!view.ok()) return view.status();
  view_ = *std::move(view);
  changed_at_ = absl::Now();
  return absl::OkStatus();
}

absl::Status FrameStream::take_credits(uint32_t credits) {
  if (credits == 0 || credits > kMostCredits - std::min(credits_, kMostCredits)) {
    return base::invalid_field("credits", fmt::format("1..{} in all, {} of them granted", kMostCredits, credits_),
                               credits);
  }
  credits_ += credits;
  return absl::OkStatus();
}

void FrameStream::see(const scene::SnapshotPtr& snapshot) {
  if (snapshot == nullptr) return finish(absl::NotFoundError("scene: was deleted"));
  snapshot_ = snapshot;
  changed_at_ = absl::Now();
  advance();
}

std::optional<FrameStream::Shown> FrameStream::wanted() const {
  if (!view_.has_value() || snapshot_ == nullptr || snapshot_->meshes.empty()) return std::nullopt;
  if (snapshot_->revision < view_->min_revision) return std::nullopt;
  return Shown{snapshot_->revision, view_->sequence, false};
}

/// Begins what can be begun.
void FrameStream::advance() {
  const std::optional<Shown> newest = wanted();
  if (closing_ || !newest.has_value()) return;
  const bool one_waits = std::any_of(flights_.begin(), flights_.end(), [](const auto& f) { return !f->shown; });
  const size_t promised = flights_.size() + (ready_.has_value() ? 1 : 0);
  if (one_waits || flights_.size() >= kMostFlights || promised >= credits_) return;
  if (*newest > begun_) return start(false);
  if (!view_->lossless_at_rest || begun_.at_rest || promised > 0) return;
  if (absl::Now() - changed_at_ >= kRest) return start(true);
  wake_at(changed_at_ + kRest);
}

void FrameStream::start(bool at_rest) {
  const auto flight = std::make_shared<Flight>(Flight{at_rest, {}, {}});
  session::FrameTask task = view_->moving;
  if (at_rest) task.encoding = {.format = encode::ImageFormat::kPng};
  task.request.scene = snapshot_;
  task.latest = [link = link_, flight](render::FrameRequest& request) {
    const absl::MutexLock lock(&link->mutex);
    return link->reactor != nullptr && link->reactor->choose(*flight, request);
  };
  task.done = [link = link_, flight](absl::StatusOr<session::EncodedFrame> frame) {
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->end(flight, std::move(frame));
  };
  const auto job = render_thread_.submit(std::move(task));
  if (job.ok()) {
    flight->job = *job;
    flights_.push_back(flight);
  } else if (absl::IsResourceExhausted(job.status())) {
    wake_at(absl::Now() + kRetry);
  } else {
    finish(job.status());
  }
}

/// On the render thread, as the frame's turn comes: whether it is still wanted, and what it shows.
bool FrameStream::choose(Flight& flight, render::FrameRequest& request) {
  const std::optional<Shown> newest = wanted();
  if (closing_ || !newest.has_value()) return false;
  const bool is_new = *newest > begun_;
  if (flight.at_rest ? is_new : !is_new) return false;
  const render::PixelFormat format = request.format;
  request = view_->moving.request;
  request.format = format;
  request.scene = snapshot_;
  flight.shown = begun_ = Shown{newest->revision, newest->view_sequence, flight.at_rest};
  advance();
  return true;
}

void FrameStream::end(const std::shared_ptr<Flight>& flight, absl::StatusOr<session::EncodedFrame> frame) {
  std::erase(flights_, flight);
  if (!frame.ok() && !absl::IsCancelled(frame.status())) return finish(frame.status());
  if (frame.ok() && *flight->shown > sent_ && (!ready_.has_value() || *flight->shown > ready_->first)) {
    ready_.emplace(*flight->shown, *std::move(frame));
    write_next();
  }
  advance();
}

void FrameStream::write_next() {
  if (writing_ || closing_ || !ready_.has_value() || credits_ == 0) return;
  --credits_;
  auto [shown, frame] = *std::exchange(ready_, std::nullopt);
  sent_ = shown;
  message_.Clear();
  v1::StreamedFrame& out = *message_.mutable_frame();
  to_proto(std::move(frame), *out.mutable_frame());
  out.set_view_sequence(shown.view_sequence);
  out.set_at_rest(shown.at_rest);
  writing_ = true;
  written_at_ = absl::Now();
  StartWrite(&message_);
}

/// No later than `due`. A new alarm: to set one again would end the function that it runs.
void FrameStream::wake_at(absl::Time due) {
  if (due >= wakes_at_) return;
  wakes_at_ = due;
  link_->alarm.emplace();
  link_->alarm->Set(absl::ToChronoTime(due), [link = link_](bool ok) {
    if (!ok) return;
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->at_alarm();
  });
}

void FrameStream::at_alarm() {
  wakes_at_ = absl::InfiniteFuture();
  if (closing_) return;
  const absl::Time now = absl::Now();
  if (!writing_ && now - written_at_ >= kHeartbeat) {
    message_.Clear();
    message_.mutable_heartbeat()->set_revision(snapshot_ == nullptr ? 0 : snapshot_->revision);
    writing_ = true;
    written_at_ = now;
    StartWrite(&message_);
  }
  wake_at(std::max(written_at_, now - kHeartbeat / 2) + kHeartbeat);
  advance();
}

/// A write that is under way is waited for.
void FrameStream::finish(const absl::Status& status) {
  if (finished_) return;
  closing_ = true;
  if (writing_) {
    if (!ending_.has_value()) ending_ = status;
    return;
  }
  finished_ = true;
  ready_.reset();
  Finish(to_grpc(status));
}

void FrameStream::cancel_flights() {
  std::vector<std::shared_ptr<session::FrameJob>> jobs;
  {
    const absl::MutexLock lock(&link_->mutex);
    for (const auto& flight : flights_) {
      if (auto job = flight->job.lock()) jobs.push_back(std::move(job));
    }
    closing_ = true;  // nothing new begins
  }
  // Their ends take the mutex.
  for (const auto& job : jobs) render_thread_.cancel(job);
}

}  // namespace diaphane::service

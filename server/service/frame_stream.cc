#include "service/frame_stream.h"

#include <algorithm>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/frame.h"
#include "service/convert/status.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kMostCredits = 64;
constexpr size_t kMostFlights = 3;
constexpr size_t kMostRevisions = 64;
constexpr absl::Duration kSharpAfter = absl::Milliseconds(60);
constexpr absl::Duration kLosslessAfter = absl::Milliseconds(150);
constexpr absl::Duration kHeartbeat = absl::Seconds(5);
constexpr absl::Duration kRetry = absl::Milliseconds(20);  // when the render queue is full

/// What the renderer itself took.
double work_ms(const session::EncodedFrame& frame) {
  double sum = 0;
  for (const render::StageTime& stage : frame.stages) {
    if (stage.stage != "queue" && stage.stage != "encode") sum += stage.milliseconds;
  }
  return sum;
}

}  // namespace

FrameStream::FrameStream(scene::SceneStore& store, session::RenderThread& render_thread, base::WorkerPool& video,
                         const ServiceLimits& limits, OpenStreams& open_streams)
    : store_(store), render_thread_(render_thread), video_(video), limits_(limits), open_streams_(open_streams) {
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
  absl::Status taken = base::invalid_field("part", "a view, credits or key_frame", "nothing");
  if (request.has_view()) taken = take_view(request.view());
  if (request.part_case() == v1::StreamFramesRequest::kCredits) taken = take_credits(request.credits());
  if (request.has_key_frame()) {
    key_frame_wanted_ = true;
    taken = absl::OkStatus();
  }
  if (taken.ok()) advance();
  return taken;
}

absl::Status FrameStream::open(const v1::StreamOpening& opening) {
  if (watch_ != nullptr) return base::invalid_field("part", "one opening", "a second");
  {
    const absl::MutexLock lock(&link_->mutex);
    every_revision_ = opening.every_revision();
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
  if (every_revision_ && view->aim != session::PaceAim{}) {
    return base::invalid_field(view->aim.frames_per_second > 0 ? "frames_per_second" : "bytes_per_second",
                               "0 with every_revision",
                               std::max(view->aim.frames_per_second, view->aim.bytes_per_second));
  }
  view_ = *std::move(view);
  if (view_->moving.encoding.format != encode::ImageFormat::kH264) {
    key_frame_wanted_ = false;
  } else if (encoder_ == nullptr) {
    encoder_ = std::make_shared<encode::H264Encoder>();
  }
  pace_.set_aim(view_->aim);
  std::erase_if(revisions_, [&](const scene::SnapshotPtr& snapshot) { return !shows(*snapshot); });
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
  if (every_revision_ && shows(*snapshot)) {
    revisions_.push_back(snapshot);
    if (revisions_.size() > kMostRevisions) {
      return finish(base::field_error(absl::StatusCode::kResourceExhausted,
                                      {"every_revision", fmt::format("{} that wait", revisions_.size()),
                                       fmt::format("at most {}", kMostRevisions)}));
    }
  }
  advance();
}

bool FrameStream::shows(const scene::SceneSnapshot& snapshot) const {
  return view_.has_value() && !snapshot.meshes.empty() && snapshot.revision >= view_->min_revision;
}

scene::SnapshotPtr FrameStream::next_snapshot() const {
  if (!revisions_.empty()) return revisions_.front();
  return snapshot_ != nullptr && shows(*snapshot_) ? snapshot_ : nullptr;
}

std::optional<FrameStream::Shown> FrameStream::wanted() const {
  const scene::SnapshotPtr next = next_snapshot();
  if (next == nullptr) return std::nullopt;
  return Shown{next->revision, view_->sequence, Rest::kMoving};
}

/// Begins what can be begun.
void FrameStream::advance() {
  const std::optional<Shown> newest = wanted();
  if (closing_ || !newest.has_value()) return;
  const bool one_waits = std::any_of(flights_.begin(), flights_.end(), [](const auto& f) { return !f->shown; });
  const size_t promised = flights_.size() + drawn_.size() + ready_.size();
  if (one_waits || flights_.size() >= kMostFlights || promised >= credits_) return;
  if (*newest <= begun_) return promised == 0 ? advance_at_rest() : void();
  const absl::Time now = absl::Now();
  if (now < pace_.next_start()) return wake_at(pace_.next_start());
  pace_.began(now);
  start(Rest::kMoving);
}

void FrameStream::advance_at_rest() {
  if (key_frame_wanted_) return start(Rest::kSharp);
  const bool sharpen = begun_reduced_ && begun_.rest == Rest::kMoving;
  if (!sharpen && (!view_->lossless_at_rest || begun_.rest == Rest::kLossless)) return;
  const absl::Time due = changed_at_ + (sharpen ? kSharpAfter : kLosslessAfter);
  if (absl::Now() < due) return wake_at(due);
  start(sharpen ? Rest::kSharp : Rest::kLossless);
}

void FrameStream::start(Rest rest) {
  const auto flight = std::make_shared<Flight>(Flight{rest, absl::Now()});
  session::FrameTask task = view_->moving;
  task.request.scene = next_snapshot();
  task.latest = [link = link_, flight](render::FrameRequest& request, encode::Encoding& encoding) {
    const absl::MutexLock lock(&link->mutex);
    return link->reactor != nullptr && link->reactor->choose(*flight, request, encoding);
  };
  task.begun = [link = link_] {
    const absl::MutexLock lock(&link->mutex);
    if (link->reactor != nullptr) link->reactor->advance();
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
bool FrameStream::choose(Flight& flight, render::FrameRequest& request, encode::Encoding& encoding) {
  const std::optional<Shown> newest = wanted();
  if (closing_ || !newest.has_value()) return false;
  const bool moving = flight.rest == Rest::kMoving;
  if (moving != (*newest > begun_)) return false;
  request = view_->moving.request;
  request.scene = next_snapshot();
  encoding = view_->moving.encoding;
  if (flight.rest == Rest::kLossless) encoding = {.format = encode::ImageFormat::kPng};
  if (moving) begun_reduced_ = flight.reduced = pace_.reduce(request, encoding);
  if (encoding.format == encode::ImageFormat::kH264) {
    flight.video = {encoding.bits_per_second, std::exchange(key_frame_wanted_, false)};
  }
  if (!revisions_.empty()) revisions_.pop_front();
  flight.shown = begun_ = Shown{newest->revision, newest->view_sequence, flight.rest};
  return true;
}

void FrameStream::end(const FlightPtr& flight, absl::StatusOr<session::EncodedFrame> frame) {
  if (!frame.ok()) {
    std::erase(flights_, flight);
    if (!absl::IsCancelled(frame.status())) return finish(frame.status());
    return advance();
  }
  if (flight->rest == Rest::kMoving && frame->pixels.rgba.empty()) {
    pace_.moved({flight->began, absl::Now(), work_ms(*frame), frame->bytes.size()});
  }
  flight->frame = *std::move(frame);
  if (every_revision_ || encoder_ != nullptr) {
    while (!flights_.empty() && flights_.front()->frame.has_value()) {
      drawn_.push_back(flights_.front());
      flights_.erase(flights_.begin());
    }
    encode_next();
  } else {
    std::erase(flights_, flight);
    if (*flight->shown > sent_ && (ready_.empty() || *flight->shown > *ready_.front()->shown)) ready_.assign(1, flight);
  }
  write_next();
  advance();
}

/// Passes on what is encoded, up to the first frame that is not, and has that encoded.
void FrameStream::encode_next() {
  while (!closing_ && !encoding_ && !drawn_.empty()) {
    const FlightPtr flight = drawn_.front();
    if (flight->frame->pixels.rgba.empty()) {
      drawn_.pop_front();
      ready_.push_back(flight);
      continue;
    }
    encoding_ = true;
    const auto task = [link = link_, encoder = encoder_, flight] {
      const absl::Time begin = absl::Now();
      absl::StatusOr<encode::H264Frame> frame = encoder->encode(flight->frame->pixels, flight->video);
      const double milliseconds = absl::ToDoubleMilliseconds(absl::Now() - begin);
      const absl::MutexLock lock(&link->mutex);
      if (link->reactor != nullptr) link->reactor->encoded(std::move(frame), milliseconds);
    };
    if (!video_.try_submit(task)) finish(absl::ResourceExhaustedError("too many videos wait to be encoded"));
  }
}

void FrameStream::encoded(absl::StatusOr<encode::H264Frame> frame, double milliseconds) {
  encoding_ = false;
  if (closing_) return;  // nobody waits for it, and drawn_ may be gone
  if (!frame.ok()) return finish(frame.status());
  const FlightPtr flight = drawn_.front();
  drawn_.pop_front();
  render_thread_.recycle(std::exchange(flight->frame->pixels, {}));
  flight->frame->bytes = std::move(frame->bytes);
  flight->frame->stages.push_back({"encode", milliseconds, true});
  flight->key_frame = frame->key_frame;
  if (flight->rest == Rest::kMoving) {
    pace_.moved({flight->began, absl::Now(), work_ms(*flight->frame), flight->frame->bytes.size()});
  }
  ready_.push_back(flight);
  write_next();
  encode_next();
  advance();
}

void FrameStream::write_next() {
  if (writing_ || closing_ || ready_.empty() || credits_ == 0) return;
  --credits_;
  const FlightPtr flight = ready_.front();
  ready_.pop_front();
  sent_ = *flight->shown;
  message_.Clear();
  v1::StreamedFrame& out = *message_.mutable_frame();
  to_proto(*std::move(flight->frame), *out.mutable_frame());
  out.set_view_sequence(sent_.view_sequence);
  out.set_at_rest(sent_.rest == Rest::kLossless);
  out.set_reduced(flight->reduced);
  out.set_key_frame(flight->key_frame);
  writing_ = true;
  written_at_ = absl::Now();
  pace_.sent(written_at_, out.frame().image().size());
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
  ready_.clear();
  drawn_.clear();
  revisions_.clear();
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

#include "session/render_thread.h"

#include <algorithm>
#include <future>
#include <new>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "session/encode_frame.h"

namespace diaphane::session {
namespace {

// Of one frame that is kept for a later one: a picture of 4096 pixels a side, or as few floats.
constexpr size_t kMostSpentBytes = size_t{64} << 20;

size_t pixel_bytes(const render::Frame& frame) {
  if (const auto* image = std::get_if<base::Image8>(&frame.image)) return image->rgba.capacity();
  return std::get<base::ImageF>(frame.image).values.capacity() * sizeof(float);
}

// What `make` returns; what it throws, as a status: a frame too big for the machine costs that frame, not the server.
template <typename Make>
auto without_exceptions(const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory");
  } catch (const std::exception& error) {
    return absl::InternalError(error.what());
  }
}

}  // namespace

RenderThread::RenderThread(const RenderThreadOptions& options)
    : options_(options),
      // Takes every frame: next_job() holds the renderer back before the queue is full.
      encoders_(std::make_unique<base::WorkerPool>(options.encode_threads, options.max_encoding_frames)) {
  // So that frames which overlap more than those before them allocate nothing either.
  absl::MutexLock lock(&mutex_);
  const size_t most = most_at_once();
  started_.reserve(most);
  begun_.reserve(most);
  drawn_.reserve(most);
  spent_.reserve(most);
}

absl::StatusOr<std::unique_ptr<RenderThread>> RenderThread::start(const RenderThreadOptions& options,
                                                                  const RendererFactory& make_renderer) {
  std::unique_ptr<RenderThread> self(new RenderThread(options));
  std::promise<absl::Status> made;
  std::future<absl::Status> result = made.get_future();
  self->render_thread_ = std::thread([made = std::move(made), &make_renderer, self = self.get()]() mutable {
    auto renderer = without_exceptions(make_renderer);
    if (renderer.ok()) self->info_ = (*renderer)->info();
    // From here on start() may have returned, and `make_renderer` be gone.
    made.set_value(renderer.status());
    if (renderer.ok()) self->run(**renderer);
  });
  self->watching_thread_ = std::thread([self = self.get()] { self->watch(); });
  if (absl::Status status = result.get(); !status.ok()) return status;
  return self;
}

RenderThread::~RenderThread() { stop(absl::InfinitePast()); }

absl::StatusOr<std::shared_ptr<FrameJob>> RenderThread::submit(FrameTask task) {
  auto job = std::make_shared<FrameJob>(std::move(task));
  absl::MutexLock lock(&mutex_);
  if (stopping_) return absl::UnavailableError("the server is stopping");
  if (queued_.size() >= options_.max_queued_frames) {
    return base::field_error(absl::StatusCode::kResourceExhausted,
                             {"queued_frames", fmt::format("{}", queued_.size() + 1),
                              fmt::format("at most {}", options_.max_queued_frames)});
  }
  queued_.push_back(job);
  can_draw_.Signal();
  if (job->expires() != absl::InfiniteFuture()) must_watch_.Signal();
  return job;
}

bool RenderThread::is_busy() const {
  absl::MutexLock lock(&mutex_);
  return !queued_.empty() || !started_.empty();
}

void RenderThread::cancel(const std::shared_ptr<FrameJob>& job) {
  job->cancel();
  {
    absl::MutexLock lock(&mutex_);
    std::erase(queued_, job);
    std::erase(started_, job);
    fewer_.Signal();
  }
  job->finish(absl::CancelledError("cancelled by the caller"));
}

void RenderThread::stop(absl::Time deadline) {
  std::vector<JobPtr> left;
  {
    absl::MutexLock lock(&mutex_);
    stopping_ = true;
    while (!queued_.empty() || !started_.empty()) {
      if (fewer_.WaitWithDeadline(&mutex_, deadline)) break;
    }
    left = std::exchange(queued_, {});
    left.insert(left.end(), started_.begin(), started_.end());
    started_.clear();
    quit_ = true;
    can_draw_.Signal();
    must_watch_.Signal();
  }
  for (const JobPtr& job : left) {
    job->cancel();
    job->finish(absl::UnavailableError("the server is stopping"));
  }
  if (render_thread_.joinable()) render_thread_.join();
  if (watching_thread_.joinable()) watching_thread_.join();
  encoders_.reset();
}

void RenderThread::run(render::FrameRenderer& renderer) {
  while (const JobPtr job = next_job()) {
    recycle_spent(renderer);
    draw(renderer, job);
  }
}

void RenderThread::recycle(base::Image8 pixels) {
  render::Frame frame;
  frame.image = std::move(pixels);
  absl::MutexLock lock(&mutex_);
  keep(std::move(frame));
}

void RenderThread::keep(render::Frame frame) {
  const size_t bytes = pixel_bytes(frame);
  if (bytes == 0 || bytes > kMostSpentBytes || spent_.size() >= options_.max_encoding_frames) return;
  spent_.push_back(std::move(frame));
}

void RenderThread::recycle_spent(render::FrameRenderer& renderer) {
  absl::MutexLock lock(&mutex_);
  for (render::Frame& frame : spent_) renderer.recycle(std::move(frame));
  spent_.clear();
}

RenderThread::JobPtr RenderThread::next_job() {
  absl::MutexLock lock(&mutex_);
  while (!quit_ && (queued_.empty() || encoding_ >= options_.max_encoding_frames)) can_draw_.Wait(&mutex_);
  if (quit_) return nullptr;
  waiting_scenes_.clear();
  for (const JobPtr& waiting : queued_) waiting_scenes_.push_back(&waiting->scene());
  const auto chosen = queued_.begin() + static_cast<ptrdiff_t>(shares_.choose(waiting_scenes_));
  JobPtr job = *chosen;
  queued_.erase(chosen);
  job->begin();
  started_.push_back(job);
  if (job->expires() != absl::InfiniteFuture()) must_watch_.Signal();  // its time limit runs
  return job;
}

void RenderThread::draw(render::FrameRenderer& renderer, const JobPtr& job) {
  const double queued_ms = milliseconds_since(job->submitted());
  if (!job->choose()) return end(job, absl::CancelledError("the frame is not wanted any more"));
  if (job->tells_begun()) {
    absl::MutexLock lock(&mutex_);
    begun_.push_back(job);
    must_watch_.Signal();
  }
  const absl::Time begin = absl::Now();
  absl::StatusOr<render::Frame> frame =
      without_exceptions([&] { return renderer.render(job->request(), job->cancelled()); });
  {
    absl::MutexLock lock(&mutex_);
    shares_.book(job->scene(), milliseconds_since(begin));
  }
  if (job->cancelled()) return;  // Whoever cancelled it ends it.
  if (!frame.ok()) return end(job, frame.status());
  frame->stages.insert(frame->stages.begin(), {"queue", queued_ms, true});
  {
    absl::MutexLock lock(&mutex_);
    ++encoding_;
    drawn_.push_back({job, *std::move(frame)});
  }
  const auto task = [this] { encode_next(); };
  if (!encoders_->try_submit(task)) task();
}

void RenderThread::encode_next() {
  Drawn drawn;
  {
    absl::MutexLock lock(&mutex_);
    drawn = std::move(drawn_.front());
    drawn_.erase(drawn_.begin());
  }
  absl::StatusOr<EncodedFrame> encoded = absl::CancelledError("the frame is not wanted any more");
  const bool wanted = !drawn.job->cancelled();  // else whoever cancelled it ends it
  if (wanted) encoded = without_exceptions([&] { return encode_frame(drawn.frame, drawn.job->encoding()); });
  {
    absl::MutexLock lock(&mutex_);
    --encoding_;
    keep(std::move(drawn.frame));
    if (!queued_.empty()) can_draw_.Signal();
  }
  if (wanted) end(drawn.job, std::move(encoded));
}

void RenderThread::end(const JobPtr& job, absl::StatusOr<EncodedFrame> result) {
  job->finish(std::move(result));
  absl::MutexLock lock(&mutex_);
  std::erase(started_, job);
  fewer_.Signal();
}

void RenderThread::watch() {
  std::vector<JobPtr> expired, begun;
  begun.reserve(most_at_once());
  for (;;) {
    {
      absl::MutexLock lock(&mutex_);
      if (quit_) return;
      const absl::Time now = absl::Now();
      absl::Time next = absl::InfiniteFuture();
      for (std::vector<JobPtr>* jobs : {&queued_, &started_}) {
        std::erase_if(*jobs, [&](const JobPtr& job) {
          if (job->expires() > now) {
            next = std::min(next, job->expires());
            return false;
          }
          job->cancel();
          expired.push_back(job);
          return true;
        });
      }
      std::swap(begun, begun_);
      if (expired.empty() && begun.empty()) {
        must_watch_.WaitWithDeadline(&mutex_, next);
        continue;
      }
      if (!expired.empty()) fewer_.Signal();
    }
    for (const JobPtr& job : begun) job->tell_begun();
    begun.clear();
    for (const JobPtr& job : expired) job->finish(job->expired());
    expired.clear();
  }
}

}  // namespace diaphane::session

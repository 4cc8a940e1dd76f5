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
      encoders_(std::make_unique<base::WorkerPool>(options.encode_threads, options.max_encoding_frames)) {}

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
  self->deadline_thread_ = std::thread([self = self.get()] { self->watch_deadlines(); });
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
  changed_.SignalAll();
  return job;
}

void RenderThread::cancel(const std::shared_ptr<FrameJob>& job) {
  job->cancel();
  {
    absl::MutexLock lock(&mutex_);
    std::erase(queued_, job);
    std::erase(started_, job);
    changed_.SignalAll();
  }
  job->finish(absl::CancelledError("cancelled by the caller"));
}

void RenderThread::stop(absl::Time deadline) {
  std::vector<JobPtr> left;
  {
    absl::MutexLock lock(&mutex_);
    stopping_ = true;
    while (!queued_.empty() || !started_.empty()) {
      if (changed_.WaitWithDeadline(&mutex_, deadline)) break;
    }
    left = std::exchange(queued_, {});
    left.insert(left.end(), started_.begin(), started_.end());
    started_.clear();
    quit_ = true;
    changed_.SignalAll();
  }
  for (const JobPtr& job : left) {
    job->cancel();
    job->finish(absl::UnavailableError("the server is stopping"));
  }
  if (render_thread_.joinable()) render_thread_.join();
  if (deadline_thread_.joinable()) deadline_thread_.join();
  encoders_.reset();
}

void RenderThread::run(render::FrameRenderer& renderer) {
  while (const JobPtr job = next_job()) draw(renderer, job);
}

RenderThread::JobPtr RenderThread::next_job() {
  absl::MutexLock lock(&mutex_);
  while (!quit_ && (queued_.empty() || encoding_ >= options_.max_encoding_frames)) changed_.Wait(&mutex_);
  if (quit_) return nullptr;
  std::vector<const std::string*> scenes;
  for (const JobPtr& waiting : queued_) scenes.push_back(&waiting->scene());
  const auto chosen = queued_.begin() + static_cast<ptrdiff_t>(shares_.choose(scenes));
  JobPtr job = *chosen;
  queued_.erase(chosen);
  job->begin();
  started_.push_back(job);
  changed_.SignalAll();  // its time limit runs
  return job;
}

void RenderThread::draw(render::FrameRenderer& renderer, const JobPtr& job) {
  const double queued_ms = milliseconds_since(job->submitted());
  if (!job->choose()) return end(job, absl::CancelledError("the frame is not wanted any more"));
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
  }
  const auto drawn = std::make_shared<render::Frame>(*std::move(frame));
  if (!encoders_->try_submit([this, job, drawn] { encode(job, std::move(*drawn)); })) encode(job, std::move(*drawn));
}

void RenderThread::encode(const JobPtr& job, render::Frame frame) {
  if (!job->cancelled()) {
    end(job, without_exceptions([&] { return encode_frame(std::move(frame), job->encoding()); }));
  }
  absl::MutexLock lock(&mutex_);
  --encoding_;
  changed_.SignalAll();
}

void RenderThread::end(const JobPtr& job, absl::StatusOr<EncodedFrame> result) {
  job->finish(std::move(result));
  absl::MutexLock lock(&mutex_);
  std::erase(started_, job);
  changed_.SignalAll();
}

void RenderThread::watch_deadlines() {
  std::vector<JobPtr> expired;
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
      if (expired.empty()) {
        changed_.WaitWithDeadline(&mutex_, next);
        continue;
      }
      changed_.SignalAll();
    }
    for (const JobPtr& job : expired) job->finish(job->expired());
    expired.clear();
  }
}

}  // namespace diaphane::session

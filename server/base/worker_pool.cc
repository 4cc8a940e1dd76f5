#include "base/worker_pool.h"

#include <utility>

namespace diaphane::base {

WorkerPool::WorkerPool(size_t threads, size_t max_queued) : tasks_(max_queued) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

WorkerPool::~WorkerPool() {
  {
    absl::MutexLock lock(&mutex_);
    stopping_ = true;
  }
  for (std::thread& thread : threads_) thread.join();
}

bool WorkerPool::try_submit(std::function<void()> task) {
  absl::MutexLock lock(&mutex_);
  if (queued_ == tasks_.size()) return false;
  tasks_[(first_ + queued_++) % tasks_.size()] = std::move(task);
  return true;
}

void WorkerPool::run() {
  for (;;) {
    std::function<void()> task;
    {
      const auto has_work = [this]() ABSL_SHARED_LOCKS_REQUIRED(mutex_) { return stopping_ || queued_ > 0; };
      absl::MutexLock lock(&mutex_, absl::Condition(&has_work));
      if (queued_ == 0) return;
      task = std::exchange(tasks_[first_], nullptr);
      first_ = (first_ + 1) % tasks_.size();
      --queued_;
    }
    task();
  }
}

}  // namespace diaphane::base

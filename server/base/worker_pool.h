// Threads that take work off threads which must not be kept busy.
#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace diaphane::base {

/// A fixed number of threads that run tasks from a bounded queue, oldest first. Thread-safe. A task must not throw.
class WorkerPool {
 public:
  /// `threads` and `max_queued` are at least 1.
  WorkerPool(size_t threads, size_t max_queued);

  /// Runs what is queued, then ends the threads. Not from a task.
  ~WorkerPool();

  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// False, and `task` is dropped, when `max_queued` tasks wait already. Never blocks.
  [[nodiscard]] bool try_submit(std::function<void()> task) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void run() ABSL_LOCKS_EXCLUDED(mutex_);

  absl::Mutex mutex_;
  // A ring, so that no task that fits a std::function costs an allocation.
  std::vector<std::function<void()>> tasks_ ABSL_GUARDED_BY(mutex_);
  size_t first_ ABSL_GUARDED_BY(mutex_) = 0;
  size_t queued_ ABSL_GUARDED_BY(mutex_) = 0;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace diaphane::base

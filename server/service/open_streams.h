// The streams that a stopping server says goodbye to.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace diaphane::service {

/// Thread-safe. What it calls it calls with its lock held: it must be quick and not call back.
class OpenStreams {
 public:
  OpenStreams() = default;
  OpenStreams(const OpenStreams&) = delete;
  OpenStreams& operator=(const OpenStreams&) = delete;
  /// Every stream is gone: whoever removed the last has let go of the lock.
  ~OpenStreams() { absl::MutexLock lock(&mutex_); }

  /// `end` is called once when the server stops, at once where it does already; never after remove().
  uint64_t add(std::function<void()> end) {
    absl::MutexLock lock(&mutex_);
    if (ended_) end();
    ends_.emplace(++last_, std::move(end));
    return last_;
  }
  void remove(uint64_t id) {
    absl::MutexLock lock(&mutex_);
    ends_.erase(id);
  }
  void end_all() {
    absl::MutexLock lock(&mutex_);
    ended_ = true;
    for (const auto& [id, end] : ends_) end();
  }

 private:
  absl::Mutex mutex_;
  std::map<uint64_t, std::function<void()>> ends_ ABSL_GUARDED_BY(mutex_);
  uint64_t last_ ABSL_GUARDED_BY(mutex_) = 0;
  bool ended_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace diaphane::service

// Who edits scenes, over connections that break.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"

namespace diaphane::service {

/// One that opens streams of edits, one in place of another. Thread-safe.
class Editor {
 public:
  /// From here on only what comes with the number that it returns is applied. Waits for what is being applied.
  uint64_t take_over() {
    const absl::MutexLock lock(&mutex_);
    return ++newest_;
  }

  /// What `edit` returns; ABORTED, and it is not called, once another stream took over from `stream`.
  absl::Status apply(uint64_t stream, absl::FunctionRef<absl::Status()> edit) {
    const absl::MutexLock lock(&mutex_);
    if (stream != newest_) return absl::AbortedError("another stream of the same editor took the place of this");
    return edit();
  }

 private:
  absl::Mutex mutex_;
  uint64_t newest_ ABSL_GUARDED_BY(mutex_) = 0;
};

/// Those whose streams are open. Thread-safe.
class Editors {
 public:
  /// The same one for the same `id`, of one scene, for as long as any stream keeps it; one of its own where `id` is
  /// empty.
  std::shared_ptr<Editor> find(const std::string& scene, const std::string& id) {
    if (id.empty()) return std::make_shared<Editor>();
    const absl::MutexLock lock(&mutex_);
    std::erase_if(editors_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<Editor>& known = editors_[{scene, id}];
    std::shared_ptr<Editor> editor = known.lock();
    if (editor == nullptr) known = editor = std::make_shared<Editor>();
    return editor;
  }

 private:
  absl::Mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::weak_ptr<Editor>> editors_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace diaphane::service

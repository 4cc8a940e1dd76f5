// Answers to recent mutations, for clients that ask again.
#pragma once

#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"

namespace diaphane::service {

/// Remembers the answers to the last `max_entries` mutations that succeeded and had a request id. Thread-safe.
class ReplyMemory {
 public:
  /// A call that may be answered from memory, or is to be remembered. Move-only; one thread at a time.
  class Call {
   public:
    Call(Call&& other) noexcept;
    Call& operator=(Call&&) = delete;
    ~Call();

    /// What was answered the first time, if there was one.
    const std::optional<std::string>& reply() const { return reply_; }
    /// The call was applied and this is its answer. A call that goes without it may be tried again.
    void remember(std::string reply);

   private:
    friend class ReplyMemory;
    Call(ReplyMemory* memory, std::string key, std::string fingerprint)
        : memory_(memory), key_(std::move(key)), fingerprint_(std::move(fingerprint)) {}

    ReplyMemory* memory_;  // null: nothing to remember
    std::string key_;
    std::string fingerprint_;
    std::optional<std::string> reply_;
  };

  explicit ReplyMemory(size_t max_entries) : max_entries_(max_entries) {}

  /// `request` is the message's bytes. Errors: ABORTED while the first call of this id is under way; INVALID_ARGUMENT
  /// when the id was another request's, or is over 64 bytes. An empty id is never remembered.
  absl::StatusOr<Call> begin(std::string_view method, std::string_view request_id, std::string_view request)
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Entry {
    std::string key;
    std::string fingerprint;
    std::string reply;
  };

  void end(const std::string& key) ABSL_LOCKS_EXCLUDED(mutex_);
  void remember(Entry entry) ABSL_LOCKS_EXCLUDED(mutex_);

  const size_t max_entries_;
  absl::Mutex mutex_;
  std::set<std::string> under_way_ ABSL_GUARDED_BY(mutex_);
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);  // the last used first
  std::map<std::string_view, std::list<Entry>::iterator> entry_of_key_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace diaphane::service

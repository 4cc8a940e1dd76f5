#include "service/reply_memory.h"

#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/check.h"
#include "service/sha256.h"

namespace diaphane::service {

ReplyMemory::Call::Call(Call&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)),
      key_(std::move(other.key_)),
      fingerprint_(std::move(other.fingerprint_)),
      reply_(std::move(other.reply_)) {}

ReplyMemory::Call::~Call() {
  if (memory_ != nullptr) memory_->end(key_);
}

void ReplyMemory::Call::remember(std::string reply) {
  if (ReplyMemory* memory = std::exchange(memory_, nullptr)) memory->remember({key_, fingerprint_, std::move(reply)});
}

absl::StatusOr<ReplyMemory::Call> ReplyMemory::begin(std::string_view method, std::string_view request_id,
                                                     std::string_view request) {
  if (request_id.empty()) return Call(nullptr, {}, {});
  if (absl::Status length = check_length("request_id", request_id, 64); !length.ok()) return length;
  Call call(nullptr, fmt::format("{}/{}", method, request_id), sha256(request));
  absl::MutexLock lock(&mutex_);
  if (const auto known = entry_of_key_.find(call.key_); known != entry_of_key_.end()) {
    if (known->second->fingerprint != call.fingerprint_) {
      return base::invalid_field("request_id", "new, or of the same request as before", request_id);
    }
    entries_.splice(entries_.begin(), entries_, known->second);
    call.reply_ = known->second->reply;
    return call;
  }
  if (!under_way_.insert(call.key_).second) {
    return base::field_error(absl::StatusCode::kAborted,
                             {"request_id", std::string(request_id), "of no request that is under way"});
  }
  call.memory_ = this;
  return call;
}

void ReplyMemory::end(const std::string& key) {
  absl::MutexLock lock(&mutex_);
  under_way_.erase(key);
}

void ReplyMemory::remember(Entry entry) {
  absl::MutexLock lock(&mutex_);
  under_way_.erase(entry.key);
  entries_.push_front(std::move(entry));
  entry_of_key_.emplace(entries_.front().key, entries_.begin());
  if (entries_.size() <= max_entries_) return;
  entry_of_key_.erase(entries_.back().key);
  entries_.pop_back();
}

}  // namespace diaphane::service

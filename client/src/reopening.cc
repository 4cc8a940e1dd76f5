#include "reopening.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace diaphane::internal {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstPause{50}, kLongestPause{1'000};

}  // namespace

absl::Status Reopening::wait_after(const absl::Status& status) {
  if (stopped()) return absl::CancelledError("the stream was closed");
  const bool may_come_back =
      absl::IsUnavailable(status) || absl::IsCancelled(status) || absl::IsInternal(status) || status.ok();
  const auto now = std::chrono::steady_clock::now();
  if (!broken_since_.has_value()) {
    broken_since_ = now;
    pause_ = kFirstPause;
  }
  if (!may_come_back) return status;
  if (now - *broken_since_ >= timeout_) return status.ok() ? absl::UnavailableError("the stream ended") : status;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop_.get_token(), pause_, [] { return false; });
  pause_ = std::min(2 * pause_, kLongestPause);
  return stopped() ? absl::CancelledError("the stream was closed") : absl::OkStatus();
}

}  // namespace diaphane::internal

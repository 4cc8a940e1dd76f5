#include "retry.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <random>

namespace diaphane::internal {
namespace {

using Clock = std::chrono::system_clock;  // gRPC deadlines are wall-clock times
using std::chrono::milliseconds;

constexpr milliseconds kFirstPause{50};
constexpr milliseconds kLongestPause{1'000};

// False once stop is requested.
bool pause(milliseconds duration, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, duration, [] { return false; });
  return !stop.stop_requested();
}

// Clients that lost the same server do not come back in step.
milliseconds jittered(milliseconds duration) {
  thread_local std::minstd_rand generator{std::random_device{}()};
  return milliseconds(static_cast<int64_t>(duration.count() * std::uniform_real_distribution(0.7, 1.0)(generator)));
}

// ABORTED: the server is still at an earlier attempt, whose connection broke.
bool may_repeat(grpc::StatusCode code) {
  return code == grpc::StatusCode::UNAVAILABLE || code == grpc::StatusCode::ABORTED;
}

}  // namespace

absl::Status run_with_retries(const RetryPolicy& policy,
                              const std::function<grpc::Status(grpc::ClientContext&)>& attempt) {
  const Clock::time_point deadline = Clock::now() + policy.call_timeout;
  const Clock::time_point last_retry = std::min(deadline, Clock::now() + policy.unavailable_timeout);
  milliseconds wait = kFirstPause;
  grpc::Status unavailable;
  while (true) {
    if (policy.stop.stop_requested()) return absl::CancelledError("stopped");
    grpc::ClientContext context;
    context.set_deadline(deadline);
    grpc::Status status;
    {
      const std::stop_callback cancel(policy.stop, [&context] { context.TryCancel(); });
      status = attempt(context);
    }
    if (policy.stop.stop_requested() && !status.ok()) return absl::CancelledError("stopped");
    // An attempt that still waits for a connection when the time is over does not know why there is none.
    if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED && !unavailable.ok()) return to_absl(unavailable);
    if (!may_repeat(status.error_code()) || Clock::now() >= last_retry) return to_absl(status);
    unavailable = status;
    if (!pause(jittered(wait), policy.stop)) return absl::CancelledError("stopped");
    wait = std::min(2 * wait, kLongestPause);
  }
}

absl::Status to_absl(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  return {static_cast<absl::StatusCode>(status.error_code()), status.error_message()};
}

}  // namespace diaphane::internal

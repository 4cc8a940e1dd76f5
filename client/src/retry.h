// Trying again while a server does not answer.
#pragma once

#include <chrono>
#include <functional>
#include <stop_token>

#include "absl/status/status.h"
#include "grpcpp/client_context.h"
#include "grpcpp/support/status.h"

namespace diaphane::internal {

struct RetryPolicy {
  std::chrono::milliseconds call_timeout;         ///< for all attempts together
  std::chrono::milliseconds unavailable_timeout;  ///< for how long UNAVAILABLE and ABORTED are tried again
  std::stop_token stop;                           ///< cancels the attempt, or the pause, in progress
};

/// Runs `attempt`, each time with a fresh context that carries the deadline, until it returns anything but UNAVAILABLE
/// or the time is over. `attempt` must be safe to repeat. Thread-safe.
absl::Status run_with_retries(const RetryPolicy& policy,
                              const std::function<grpc::Status(grpc::ClientContext&)>& attempt);

/// The same code and message; codes have the same numbers in both.
absl::Status to_absl(const grpc::Status& status);

}  // namespace diaphane::internal

// When a stream that broke is opened again.
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>

#include "absl/status/status.h"
#include "diaphane/client.h"

namespace diaphane::internal {

/// Thread-safe where it says so; else one thread.
class Reopening {
 public:
  explicit Reopening(const ClientOptions& options) : timeout_(options.connect_timeout), outer_(options.stop) {}

  /// Something came: a break from now on is another one.
  void succeeded() { broken_since_.reset(); }

  /// Pauses, longer each time, and is OK where a stream that ended with `status` may be opened again; else what it
  /// ended for: `status`, or CANCELLED once stopped. A proxy ends streams with UNAVAILABLE, CANCELLED or INTERNAL.
  absl::Status wait_after(const absl::Status& status);

  /// Thread-safe.
  void stop() { stop_.request_stop(); }
  bool stopped() const { return stop_.stop_requested() || outer_.stop_requested(); }

 private:
  const std::chrono::milliseconds timeout_;
  const std::stop_token outer_;
  std::stop_source stop_;
  std::optional<std::chrono::steady_clock::time_point> broken_since_;
  std::chrono::milliseconds pause_{0};
};

}  // namespace diaphane::internal

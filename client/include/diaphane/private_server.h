// A server of one's own.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"

namespace diaphane {

struct PrivateServerOptions {
  std::filesystem::path program;  ///< empty: diaphane-server beside the running executable, else the first on PATH
  std::chrono::milliseconds start_timeout{60'000};  ///< until it says that it listens
  std::chrono::milliseconds stop_timeout{5'000};    ///< until it is killed, once it was asked to stop
  bool verbose = false;                             ///< its log goes to this process's stderr
  std::stop_token stop;                             ///< ends start() early, with CANCELLED
};

/// A diaphane-server process that listens on a Unix socket in a directory that only this user can enter. It ends with
/// this object; should this process die first, it ends by itself. Movable; one thread at a time.
class PrivateServer {
 public:
  /// Starts the server and waits until it listens. Starts a process, but does not fork: safe beside threads and gRPC.
  ///
  /// Errors: NOT_FOUND no such program; UNAVAILABLE it ended before it listened (with its last words);
  /// DEADLINE_EXCEEDED start_timeout; CANCELLED; INTERNAL the directory or the process could not be made.
  static absl::StatusOr<PrivateServer> start(const PrivateServerOptions& options = {});

  PrivateServer(PrivateServer&&) noexcept;
  PrivateServer& operator=(PrivateServer&&) noexcept;
  /// Asks the server to stop, waits for it, kills it after stop_timeout, and removes the directory.
  ~PrivateServer();

  /// What Client::connect takes.
  const std::string& address() const;

 private:
  struct Process;
  explicit PrivateServer(std::unique_ptr<Process> process);

  std::unique_ptr<Process> process_;
};

}  // namespace diaphane

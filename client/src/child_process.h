// A process that was started from here.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace diaphane::internal {

/// Owns a file descriptor. Movable.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor() { close(); }

  int number() const { return number_; }
  void close();

 private:
  int number_;
};

/// A child in a process group of its own (a terminal's Ctrl-C does not reach it), with the default signal mask. Its
/// standard input stays open as long as this object; standard output can be read by line; standard error is inherited
/// or kept. One thread at a time.
class ChildProcess {
 public:
  /// posix_spawn: fork without exec would break gRPC in this process.
  static absl::StatusOr<ChildProcess> start(const std::filesystem::path& program,
                                            const std::vector<std::string>& arguments, bool inherit_stderr);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Kills it if it still runs. No zombie is left.
  ~ChildProcess();

  /// The next line of standard output, without its end. Errors: DEADLINE_EXCEEDED; CANCELLED; UNAVAILABLE once the
  /// child closed its standard output or wrote 64 KiB without a line end.
  absl::StatusOr<std::string> read_line(std::chrono::milliseconds timeout, const std::stop_token& stop);

  /// The last line that it left on standard error, or nothing when that is inherited.
  std::string last_words() const;

  /// Closes its standard input, sends SIGTERM, waits for `timeout`, then kills it.
  void stop(std::chrono::milliseconds timeout);

  /// How it ended, in words, if it ended within `timeout`.
  std::optional<std::string> wait(std::chrono::milliseconds timeout);

 private:
  ChildProcess() = default;

  pid_t pid_ = 0;  // 0 once it has been waited for
  FileDescriptor stdin_;
  FileDescriptor stdout_;
  FileDescriptor stderr_;
  std::string unread_;
};

}  // namespace diaphane::internal

// The terminal that a person sits at.
#pragma once

#include <termios.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "terminal_picture.h"

namespace diaphane::cli {

/// Of the terminal at stdout. Errors: kExitUsage where stdin and stdout are none.
absl::StatusOr<TerminalExtent> find_terminal();

/// An empty screen of its own, and keys as they are pressed; as it was before, when this goes. Ctrl-C stays a signal.
/// keys() and write() may each have a thread of their own.
class Terminal {
 public:
  /// Errors: kExitUsage where stdin and stdout are none.
  static absl::StatusOr<std::unique_ptr<Terminal>> open();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  TerminalExtent extent() const;

  /// What was typed, as the terminal sends it; waits for it up to `wait`, then empty. Errors: DATA_LOSS it is gone.
  absl::StatusOr<std::string> keys(std::chrono::milliseconds wait);

  /// Errors: DATA_LOSS it is gone.
  absl::Status write(std::string_view text);

 private:
  explicit Terminal(const termios& before) : before_(before) {}

  const termios before_;
};

}  // namespace diaphane::cli

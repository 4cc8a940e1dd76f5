// Which exit code an error means.
#pragma once

#include <string_view>

#include "absl/status/status.h"

namespace diaphane::cli {

enum ExitCode {
  kExitOk = 0,
  kExitUsage = 2,        ///< the command line itself
  kExitUnavailable = 3,  ///< no server, or it did not answer in time
  kExitRejected = 4,     ///< the server refused, or failed
  kExitFile = 5          ///< a file here cannot be read or written
};

/// INVALID_ARGUMENT "FLAG: WHAT" that exits with kExitUsage.
absl::Status usage_error(std::string_view flag, std::string_view what);

/// `status`, exiting with `code` whatever its canonical code.
absl::Status with_exit_code(absl::Status status, ExitCode code);

/// What was attached, else what the canonical code means when it came from a server.
ExitCode exit_code_of(const absl::Status& status);

/// One line on stderr: "diaphane: MESSAGE".
void print_error(const absl::Status& status);
void print_note(std::string_view message);

}  // namespace diaphane::cli

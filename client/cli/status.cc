#include "status.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "absl/strings/cord.h"
#include "fmt/format.h"

namespace diaphane::cli {
namespace {

constexpr char kExitCodePayload[] = "diaphane.cli/exit_code";

}  // namespace

absl::Status usage_error(std::string_view flag, std::string_view what) {
  return with_exit_code(absl::InvalidArgumentError(fmt::format("{}: {}", flag, what)), kExitUsage);
}

absl::Status with_exit_code(absl::Status status, ExitCode code) {
  if (!status.ok()) status.SetPayload(kExitCodePayload, absl::Cord(std::string(1, static_cast<char>(code))));
  return status;
}

ExitCode exit_code_of(const absl::Status& status) {
  if (status.ok()) return kExitOk;
  if (const auto payload = status.GetPayload(kExitCodePayload)) {
    return static_cast<ExitCode>(std::string(*payload).front());
  }
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kCancelled:
      return kExitUnavailable;
    default:
      return kExitRejected;
  }
}

void print_error(const absl::Status& status) {
  const std::string message(status.message());
  print_note(message.empty() ? absl::StatusCodeToString(status.code()) : message);
}

void print_note(std::string_view message) {
  std::string line(message);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  fmt::print(stderr, "diaphane: {}\n", line);
}

}  // namespace diaphane::cli

#include "base/status.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_split.h"
#include "fmt/format.h"

namespace diaphane::base {
namespace {

constexpr char kPayloadUrl[] = "diaphane/field_violation";
constexpr char kSeparator = '\x1f';
constexpr size_t kLongestValue = 120;

// A value as an error shows it: what a client sent, short enough for a trailer and without control characters.
std::string shown(std::string_view value) {
  std::string text(value.substr(0, kLongestValue));
  if (value.size() > kLongestValue) {
    // Not in the middle of a UTF-8 sequence, whose later bytes are 10xxxxxx.
    while (!text.empty() && (value[text.size()] & 0xC0) == 0x80) text.pop_back();
    text += "…";
  }
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

}  // namespace

absl::Status field_error(absl::StatusCode code, const FieldViolation& violation) {
  const std::string value = shown(violation.value);
  absl::Status status(code, fmt::format("{}: must be {}, got {}", violation.field, violation.range, value));
  status.SetPayload(kPayloadUrl, absl::Cord(fmt::format("{}{}{}{}{}", violation.field, kSeparator, value, kSeparator,
                                                        violation.range)));
  return status;
}

absl::Status invalid_field(std::string_view field, std::string_view range, std::string_view value) {
  return field_error(absl::StatusCode::kInvalidArgument, {std::string(field), std::string(value), std::string(range)});
}

absl::Status invalid_field(std::string_view field, std::string_view range, double value) {
  return invalid_field(field, range, fmt::format("{}", value));
}

absl::Status within(std::string_view prefix, const absl::Status& status) {
  FieldViolation violation = field_violation(status);
  if (violation.field.empty()) {
    return absl::Status(status.code(), fmt::format("{} {}", prefix, std::string(status.message())));
  }
  violation.field.insert(0, prefix);
  return field_error(status.code(), violation);
}

FieldViolation field_violation(const absl::Status& status) {
  const auto payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return {};
  const std::vector<std::string> parts = absl::StrSplit(std::string(*payload), kSeparator);
  if (parts.size() != 3) return {};
  return {parts[0], parts[1], parts[2]};
}

}  // namespace diaphane::base

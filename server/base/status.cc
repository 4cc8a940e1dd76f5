#include "base/status.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_split.h"
#include "fmt/format.h"

namespace diaphane::base {
namespace {

constexpr char kPayloadUrl[] = "diaphane/field_violation";
constexpr char kSeparator = '\x1f';

}  // namespace

absl::Status field_error(absl::StatusCode code, const FieldViolation& violation) {
  absl::Status status(code, fmt::format("{}: must be {}, got {}", violation.field, violation.range, violation.value));
  status.SetPayload(kPayloadUrl, absl::Cord(fmt::format("{}{}{}{}{}", violation.field, kSeparator, violation.value,
                                                        kSeparator, violation.range)));
  return status;
}

absl::Status invalid_field(std::string_view field, std::string_view range, std::string_view value) {
  return field_error(absl::StatusCode::kInvalidArgument,
                     {std::string(field), std::string(value), std::string(range)});
}

absl::Status invalid_field(std::string_view field, std::string_view range, double value) {
  return invalid_field(field, range, fmt::format("{}", value));
}

FieldViolation field_violation(const absl::Status& status) {
  const auto payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return {};
  const std::vector<std::string> parts = absl::StrSplit(std::string(*payload), kSeparator);
  if (parts.size() != 3) return {};
  return {parts[0], parts[1], parts[2]};
}

}  // namespace diaphane::base

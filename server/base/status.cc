#include "base/status.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace diaphane::base {
namespace {

constexpr char kPayloadUrl[] = "diaphane/field_violation";
constexpr char kSeparator = '\x1f';

}  // namespace

absl::Status field_error(absl::StatusCode code, const FieldViolation& violation) {
  absl::Status status(code, absl::StrCat(violation.field, ": must be ", violation.range, ", got ", violation.value));
  const std::string separator(1, kSeparator);
  status.SetPayload(kPayloadUrl, absl::Cord(absl::StrCat(violation.field, separator, violation.value, separator,
                                                         violation.range)));
  return status;
}

absl::Status invalid_field(std::string_view field, std::string_view range, std::string_view value) {
  return field_error(absl::StatusCode::kInvalidArgument,
                     {std::string(field), std::string(value), std::string(range)});
}

absl::Status invalid_field(std::string_view field, std::string_view range, double value) {
  return invalid_field(field, range, absl::StrCat(value));
}

FieldViolation field_violation(const absl::Status& status) {
  const auto payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return {};
  const std::vector<std::string> parts = absl::StrSplit(std::string(*payload), kSeparator);
  if (parts.size() != 3) return {};
  return {parts[0], parts[1], parts[2]};
}

}  // namespace diaphane::base

// Errors as values: a canonical code, and which field was wrong, with which value, against which range.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace diaphane::base {

/// One refused field. `field` is the path in the contract ("size.width_px"), `value` what was given, `range` what is
/// allowed.
struct FieldViolation {
  std::string field;
  std::string value;
  std::string range;
};

/// INVALID_ARGUMENT "FIELD: must be RANGE, got VALUE", with the violation attached. A long value is cut and control
/// characters are replaced: a client may have sent it. Thread-safe.
absl::Status invalid_field(std::string_view field, std::string_view range, std::string_view value);
absl::Status invalid_field(std::string_view field, std::string_view range, double value);

/// The same under another canonical code, such as RESOURCE_EXHAUSTED for a limit or NOT_FOUND for a name.
absl::Status field_error(absl::StatusCode code, const FieldViolation& violation);

/// The same error of a field within another: `prefix` comes before its field, or before the message where it names
/// none.
absl::Status within(std::string_view prefix, const absl::Status& status);

/// The violation that `status` carries, or an empty one. Thread-safe.
FieldViolation field_violation(const absl::Status& status);

}  // namespace diaphane::base

// What protobuf's JSON parser lets pass.
#pragma once

#include <string_view>

#include "absl/status/status.h"

namespace diaphane::internal {

/// OK, or INVALID_ARGUMENT when `text` is not JSON (with line and column), nests deeper than 32, or gives a field
/// twice, in whichever spelling (snake_case or camelCase). Allocates little more than the open objects' keys.
absl::Status check_json(std::string_view text);

}  // namespace diaphane::internal

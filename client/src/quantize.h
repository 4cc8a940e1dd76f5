// Positions in steps of a box.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/values.h"

namespace diaphane::internal {

/// Each axis in steps of (highest − lowest)/65535 from `lowest`, rounded; `width` numbers a value, 3 or 4, the fourth
/// 0. INVALID_ARGUMENT for a box that is none, or a value outside it.
absl::StatusOr<std::vector<uint16_t>> steps_in_box(std::span<const Vec3> values, const Vec3& lowest,
                                                   const Vec3& highest, size_t width);

}  // namespace diaphane::internal

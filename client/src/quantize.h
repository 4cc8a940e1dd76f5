// Positions in steps of a box.
#pragma once

#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "diaphane/values.h"

namespace diaphane::internal {

/// INVALID_ARGUMENT for a box that is none, or a value outside it.
absl::Status check_in_box(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest);

/// Each axis in steps of (highest − lowest)/65535 from `lowest`, rounded in single precision: at most 0.51 steps are
/// lost. `steps`: `width` numbers a value, 3 or 4, the fourth 0. The box holds the values.
void steps_in_box(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest, size_t width, uint16_t* steps);

}  // namespace diaphane::internal

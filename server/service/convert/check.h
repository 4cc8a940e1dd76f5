// The checks that every resource's conversion is made of.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "base/status.h"
#include "diaphane/v1/common.pb.h"
#include "glm/vec3.hpp"
#include "google/protobuf/field_mask.pb.h"
#include "google/protobuf/generated_enum_reflection.h"

namespace diaphane::service {

/// OK when lowest ≤ value ≤ highest; NaN never is.
absl::Status check_range(std::string_view field, double value, double lowest, double highest);

/// OK when each of x, y, z is in the range; else the error names the one that is not.
absl::Status check_range(std::string_view field, const v1::Vec3& value, double lowest, double highest);

/// OK when `text` is at most `max_bytes` long.
absl::Status check_length(std::string_view field, std::string_view text, size_t max_bytes);

/// Of coordinates; see geometry::check_finite.
inline constexpr double kLargestCoordinate = 1e18;

/// The refusal of a value that the enum has not.
template <typename Enum>
absl::Status unknown_value(std::string_view field, Enum value) {
  const auto* descriptor = google::protobuf::GetEnumDescriptor<Enum>();
  std::string known = descriptor->value(1)->name();
  for (int i = 2; i < descriptor->value_count(); ++i) known += ", " + descriptor->value(i)->name();
  return base::invalid_field(field, known, static_cast<int>(value));
}

/// A position in scene units, each coordinate finite and within ±1e18.
absl::StatusOr<glm::vec3> position_from_proto(const v1::Vec3& message, std::string_view field);

inline glm::vec3 from_proto(const v1::Vec3& message) { return {message.x(), message.y(), message.z()}; }
void to_proto(const glm::vec3& value, v1::Vec3& message);

/// OK when `mask` names at least one field, and none but those `allowed`.
absl::Status check_mask(const google::protobuf::FieldMask& mask, std::initializer_list<std::string_view> allowed);
bool names(const google::protobuf::FieldMask& mask, std::string_view path);

}  // namespace diaphane::service

#include "service/convert/check.h"

#include <algorithm>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::service {

absl::Status check_range(std::string_view field, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return absl::OkStatus();
  return base::invalid_field(field, fmt::format("{}..{}", lowest, highest), value);
}

absl::Status check_range(std::string_view field, const v1::Vec3& value, double lowest, double highest) {
  if (absl::Status x = check_range(fmt::format("{}.x", field), value.x(), lowest, highest); !x.ok()) return x;
  if (absl::Status y = check_range(fmt::format("{}.y", field), value.y(), lowest, highest); !y.ok()) return y;
  return check_range(fmt::format("{}.z", field), value.z(), lowest, highest);
}

absl::Status check_length(std::string_view field, std::string_view text, size_t max_bytes) {
  if (text.size() <= max_bytes) return absl::OkStatus();
  return base::invalid_field(field, fmt::format("at most {} bytes", max_bytes), fmt::format("{} bytes", text.size()));
}

absl::StatusOr<glm::vec3> position_from_proto(const v1::Vec3& message, std::string_view field) {
  absl::Status finite = check_range(field, message, -kLargestCoordinate, kLargestCoordinate);
  if (!finite.ok()) return finite;
  return from_proto(message);
}

void to_proto(const glm::vec3& value, v1::Vec3& message) {
  message.set_x(value.x);
  message.set_y(value.y);
  message.set_z(value.z);
}

absl::Status check_mask(const google::protobuf::FieldMask& mask, std::initializer_list<std::string_view> allowed) {
  const auto refuse = [&](std::string_view value) {
    return base::invalid_field("update_mask", fmt::format("one or more of {}", fmt::join(allowed, ", ")), value);
  };
  if (mask.paths().empty()) return refuse("none");
  for (const std::string& path : mask.paths()) {
    if (std::find(allowed.begin(), allowed.end(), path) == allowed.end()) return refuse(path);
  }
  return absl::OkStatus();
}

bool names(const google::protobuf::FieldMask& mask, std::string_view path) {
  return std::find(mask.paths().begin(), mask.paths().end(), path) != mask.paths().end();
}

}  // namespace diaphane::service

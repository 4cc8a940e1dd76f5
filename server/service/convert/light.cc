#include "service/convert/light.h"

#include "base/status.h"
#include "fmt/format.h"
#include "glm/geometric.hpp"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

constexpr double kLargestPower = 1e12;
constexpr float kShortestDirection = 1e-12f;

absl::StatusOr<glm::vec3> direction_from_proto(const v1::Vec3& message, std::string_view field) {
  const auto direction = position_from_proto(message, field);
  if (!direction.ok()) return direction;
  if (glm::length(glm::dvec3(*direction)) < kShortestDirection) {
    return base::invalid_field(field, "a direction", fmt::format("{},{},{}", message.x(), message.y(), message.z()));
  }
  return glm::vec3(glm::normalize(glm::dvec3(*direction)));
}

absl::StatusOr<scene::PointLight> point_from_proto(const v1::PointLight& message, const std::string& field) {
  const auto position = position_from_proto(message.position(), field + ".position");
  if (!position.ok()) return position.status();
  absl::Status intensity = check_range(field + ".intensity", message.intensity(), 0, kLargestPower);
  if (!intensity.ok()) return intensity;
  absl::Status radius = check_range(field + ".radius_mm", message.radius_mm(), 0, 1e6);
  if (!radius.ok()) return radius;
  return scene::PointLight{*position, from_proto(message.intensity()), message.radius_mm()};
}

absl::StatusOr<scene::LightKind> directional_from_proto(const v1::DirectionalLight& message) {
  const auto direction = direction_from_proto(message.direction(), "light.directional.direction");
  if (!direction.ok()) return direction.status();
  absl::Status irradiance = check_range("light.directional.irradiance", message.irradiance(), 0, kLargestPower);
  if (!irradiance.ok()) return irradiance;
  return scene::DirectionalLight{*direction, from_proto(message.irradiance())};
}

absl::StatusOr<scene::LightKind> spot_from_proto(const v1::SpotLight& message) {
  const auto point = point_from_proto(message.point(), "light.spot.point");
  if (!point.ok()) return point.status();
  const auto direction = direction_from_proto(message.direction(), "light.spot.direction");
  if (!direction.ok()) return direction.status();
  const float outer = message.outer_angle_deg();
  if (!(outer > 0 && outer <= 90)) return base::invalid_field("light.spot.outer_angle_deg", "above 0, up to 90", outer);
  absl::Status inner = check_range("light.spot.inner_angle_deg", message.inner_angle_deg(), 0, outer);
  if (!inner.ok()) return inner;
  return scene::SpotLight{*point, *direction, message.inner_angle_deg(), outer};
}

void point_to_proto(const scene::PointLight& point, v1::PointLight& message) {
  to_proto(point.position, *message.mutable_position());
  to_proto(point.intensity_w_sr, *message.mutable_intensity());
  message.set_radius_mm(point.radius_mm);
}

}  // namespace

absl::StatusOr<scene::LightKind> from_proto(const v1::Light& message) {
  switch (message.kind_case()) {
    case v1::Light::kPoint:
      return point_from_proto(message.point(), "light.point");
    case v1::Light::kDirectional:
      return directional_from_proto(message.directional());
    case v1::Light::kSpot:
      return spot_from_proto(message.spot());
    case v1::Light::KIND_NOT_SET:
      break;
  }
  return base::invalid_field("light.kind", "point, directional or spot", "none");
}

absl::StatusOr<scene::LightPatch> from_proto(const v1::Light& message, const google::protobuf::FieldMask& mask) {
  absl::Status known = check_mask(mask, {"point", "point.position", "point.intensity", "directional", "spot"});
  if (!known.ok()) return known;
  const absl::StatusOr<scene::LightKind> light = from_proto(message);
  if (!light.ok()) return light.status();
  scene::LightPatch patch;
  const char* kind = message.has_point() ? "point" : message.has_directional() ? "directional" : "spot";
  for (const std::string& path : mask.paths()) {
    if (path != kind && !(message.has_point() && path.starts_with("point."))) {
      return base::invalid_field("update_mask", fmt::format("of the kind given, {}", kind), path);
    }
  }
  if (names(mask, kind)) {
    patch.kind = *light;
    return patch;
  }
  const auto& point = std::get<scene::PointLight>(*light);
  if (names(mask, "point.position")) patch.position = point.position;
  if (names(mask, "point.intensity")) patch.intensity_w_sr = point.intensity_w_sr;
  return patch;
}

void to_proto(const scene::Light& light, v1::Light& message) {
  message.set_name(light.name);
  if (const auto* point = std::get_if<scene::PointLight>(&light.kind)) {
    point_to_proto(*point, *message.mutable_point());
  } else if (const auto* directional = std::get_if<scene::DirectionalLight>(&light.kind)) {
    to_proto(directional->direction, *message.mutable_directional()->mutable_direction());
    to_proto(directional->irradiance, *message.mutable_directional()->mutable_irradiance());
  } else {
    const auto& spot = std::get<scene::SpotLight>(light.kind);
    point_to_proto(spot.point, *message.mutable_spot()->mutable_point());
    to_proto(spot.direction, *message.mutable_spot()->mutable_direction());
    message.mutable_spot()->set_inner_angle_deg(spot.inner_angle_deg);
    message.mutable_spot()->set_outer_angle_deg(spot.outer_angle_deg);
  }
}

void to_proto(const scene::Changed<scene::Light>& changed, v1::LightResponse& message) {
  to_proto(changed.value, *message.mutable_light());
  message.set_scene_revision(changed.scene_revision);
}

}  // namespace diaphane::service

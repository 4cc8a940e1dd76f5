#include "service/convert/light.h"

#include "base/status.h"
#include "service/convert/check.h"

namespace diaphane::service {

absl::StatusOr<scene::PointLight> from_proto(const v1::Light& message) {
  if (!message.has_point()) return base::invalid_field("light.kind", "point", "none");
  const auto position = position_from_proto(message.point().position(), "light.point.position");
  if (!position.ok()) return position.status();
  absl::Status intensity = check_range("light.point.intensity", message.point().intensity(), 0, 1e12);
  if (!intensity.ok()) return intensity;
  return scene::PointLight{*position, from_proto(message.point().intensity())};
}

absl::StatusOr<scene::LightPatch> from_proto(const v1::Light& message, const google::protobuf::FieldMask& mask) {
  absl::Status known = check_mask(mask, {"point", "point.position", "point.intensity"});
  if (!known.ok()) return known;
  const absl::StatusOr<scene::PointLight> light = from_proto(message);
  if (!light.ok()) return light.status();
  scene::LightPatch patch;
  const bool whole = names(mask, "point");
  if (whole || names(mask, "point.position")) patch.position = light->position;
  if (whole || names(mask, "point.intensity")) patch.intensity_w_sr = light->intensity_w_sr;
  return patch;
}

void to_proto(const scene::Light& light, v1::Light& message) {
  message.set_name(light.name);
  const auto& point = std::get<scene::PointLight>(light.kind);
  to_proto(point.position, *message.mutable_point()->mutable_position());
  to_proto(point.intensity_w_sr, *message.mutable_point()->mutable_intensity());
}

void to_proto(const scene::Changed<scene::Light>& changed, v1::LightResponse& message) {
  to_proto(changed.value, *message.mutable_light());
  message.set_scene_revision(changed.scene_revision);
}

}  // namespace diaphane::service

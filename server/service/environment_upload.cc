#include "service/environment_upload.h"

#include <utility>

namespace diaphane::service {

absl::StatusOr<PayloadSpec> EnvironmentUpload::open(const Header& header) {
  absl::StatusOr<EnvironmentSpec> spec = from_proto(header);
  if (!spec.ok()) return spec.status();
  absl::StatusOr<scene::Reservation> reservation =
      store_.reserve_environment({"parent", header.parent()}, spec->width_px, spec->height_px);
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  parent_ = header.parent();
  spec_ = *std::move(spec);
  return spec_.payload;
}

absl::Status EnvironmentUpload::apply(const Payload& payload, v1::EnvironmentResponse& response) {
  absl::StatusOr<optics::LatLongMap> map = read_map(spec_, payload.bytes());
  if (!map.ok()) return map.status();
  auto light = std::make_shared<const optics::EnvironmentLight>(optics::analyse(*map));
  scene::Environment environment{{},
                                 std::make_shared<const optics::LatLongMap>(*std::move(map)),
                                 std::move(light),
                                 spec_.rotation_deg,
                                 spec_.intensity,
                                 spec_.occlusion};
  const auto changed = store_.set_environment({"parent", parent_}, std::move(environment), std::move(reservation_));
  if (!changed.ok()) return changed.status();
  to_proto(*changed, response);
  return absl::OkStatus();
}

}  // namespace diaphane::service

#include "service/texture_upload.h"

#include <utility>

namespace diaphane::service {

absl::StatusOr<PayloadSpec> TextureUpload::open(const Header& header) {
  absl::StatusOr<TextureSpec> spec = from_proto(header);
  if (!spec.ok()) return spec.status();
  absl::StatusOr<scene::Reservation> reservation =
      store_.reserve_texture({"parent", header.parent()}, spec->width_px, spec->height_px);
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  parent_ = header.parent();
  spec_ = *std::move(spec);
  return spec_.payload;
}

absl::Status TextureUpload::apply(const Payload& payload, v1::TextureResponse& response) {
  const auto created =
      store_.create_texture({"parent", parent_}, read_texture(spec_, payload.bytes()), std::move(reservation_));
  if (!created.ok()) return created.status();
  to_proto(*created, response);
  return absl::OkStatus();
}

}  // namespace diaphane::service

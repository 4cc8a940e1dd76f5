#include "service/positions_upload.h"

#include <utility>

#include "service/convert/mesh.h"
#include "service/convert/upload.h"

namespace diaphane::service {

absl::StatusOr<PayloadSpec> PositionsUpload::open(const Header& header) {
  absl::StatusOr<PayloadSpec> spec = from_proto(header);
  if (!spec.ok()) return spec;
  absl::StatusOr<scene::Reservation> reservation =
      store_.reserve_positions({"name", header.name()}, header.vertex_count(), header.has_normals());
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  mesh_ = header.name();
  return spec;
}

absl::Status PositionsUpload::apply(const Payload& payload, v1::MeshResponse& response) {
  absl::StatusOr<PayloadArrays> arrays = read_arrays(payload.spec(), payload.bytes());
  if (!arrays.ok()) return arrays.status();
  auto shape = std::make_shared<const geometry::MeshShape>(
      geometry::MeshShape{std::move(arrays->positions), std::move(arrays->normals)});
  const auto changed = store_.replace_positions({"name", mesh_}, std::move(shape), std::move(reservation_));
  if (!changed.ok()) return changed.status();
  to_proto(*changed, response);
  return absl::OkStatus();
}

}  // namespace diaphane::service

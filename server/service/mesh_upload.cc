#include "service/mesh_upload.h"

#include <utility>

#include "service/convert/mesh.h"
#include "service/convert/upload.h"

namespace diaphane::service {

absl::StatusOr<PayloadSpec> MeshUpload::open(const Header& header) {
  absl::StatusOr<PayloadSpec> spec = from_proto(header);
  if (!spec.ok()) return spec;
  const absl::StatusOr<glm::mat4> matrix = matrix_from_proto(header.mesh().scene_from_mesh());
  if (!matrix.ok()) return matrix.status();
  absl::StatusOr<scene::Reservation> reservation =
      store_.reserve_mesh({"parent", header.parent()}, {"mesh.material", header.mesh().material()}, spec->counts);
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  parent_ = header.parent();
  mesh_.material = header.mesh().material();
  mesh_.scene_from_mesh = *matrix;
  return spec;
}

absl::Status MeshUpload::apply(const Payload& payload, v1::MeshResponse& response) {
  absl::StatusOr<PayloadArrays> arrays = read_arrays(payload.spec(), payload.bytes());
  if (!arrays.ok()) return arrays.status();
  auto topology = geometry::build_topology(arrays->positions, std::move(arrays->triangles));
  if (!topology.ok()) return topology.status();
  mesh_.topology = *std::move(topology);
  mesh_.shape = std::make_shared<const geometry::MeshShape>(
      geometry::MeshShape{std::move(arrays->positions), std::move(arrays->normals)});
  if (!arrays->attributes.empty()) {
    mesh_.attributes = std::make_shared<const geometry::SurfaceAttributes>(std::move(arrays->attributes));
  }
  if (arrays->morph_targets.count > 0) {
    mesh_.morph_targets = std::make_shared<const geometry::MorphTargets>(std::move(arrays->morph_targets));
  }
  const auto created = store_.create_mesh({"parent", parent_}, std::move(mesh_), std::move(reservation_));
  if (!created.ok()) return created.status();
  to_proto(*created, response);
  return absl::OkStatus();
}

}  // namespace diaphane::service

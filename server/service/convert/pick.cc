#include "service/convert/pick.h"

#include "service/convert/check.h"
#include "service/convert/frame.h"

namespace diaphane::service {

absl::StatusOr<PickQuery> from_proto(const v1::PickRequest& message, uint64_t max_pixels) {
  const absl::StatusOr<scene::Camera> camera = from_proto(message.camera());
  if (!camera.ok()) return camera.status();
  if (absl::Status size = check_size(message.size(), max_pixels); !size.ok()) return size;
  const glm::uvec2 size_px(message.size().width_px(), message.size().height_px());
  if (absl::Status x = check_range("x_px", message.x_px(), 0, size_px.x); !x.ok()) return x;
  if (absl::Status y = check_range("y_px", message.y_px(), 0, size_px.y); !y.ok()) return y;
  return PickQuery{*camera, size_px, {message.x_px(), message.y_px()}};
}

void to_proto(const scene::Picked& picked, v1::PickedPoint& message) {
  message.set_mesh(picked.mesh);
  message.set_triangle(picked.triangle);
  to_proto(picked.barycentric, *message.mutable_barycentric());
  to_proto(glm::vec3(picked.position), *message.mutable_position());
  to_proto(glm::vec3(picked.facet_normal), *message.mutable_facet_normal());
  message.set_distance(picked.distance);
}

}  // namespace diaphane::service

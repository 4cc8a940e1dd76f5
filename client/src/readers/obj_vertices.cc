#include "readers/obj_vertices.h"

namespace diaphane::readers {

absl::StatusOr<uint32_t> ObjVertices::vertex_of(const Corner& corner) {
  const Names wanted = {corner.texture, corner.normal};
  if (wanted == Names{-1, -1}) return corner.position;
  if (names_of_vertex_.empty()) names_of_vertex_.assign(builder_.vertex_count(), Names{-1, -1});
  if (take(corner.position, wanted, names_of_vertex_[corner.position])) return corner.position;

  const std::array<int32_t, 3> key = {static_cast<int32_t>(corner.position), wanted[0], wanted[1]};
  const auto [entry, is_new] = copies_.try_emplace(key, static_cast<uint32_t>(builder_.vertex_count()));
  if (!is_new) return entry->second;
  const absl::Status status = builder_.repeat_vertex(corner.position);
  if (!status.ok()) return status;
  Names has = {-1, -1};
  take(entry->second, wanted, has);
  return entry->second;
}

// Whether `vertex`, which `has` those names, can be what is `wanted`; gives it what it had none of.
bool ObjVertices::take(uint32_t vertex, const Names& wanted, Names& has) {
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] >= 0 && has[i] >= 0 && wanted[i] != has[i]) return false;
  }
  if (wanted[0] >= 0 && has[0] < 0) {
    const ObjTextureCoordinate& texture = textures_[static_cast<size_t>(wanted[0])];
    builder_.set_texture_coordinate(vertex, texture.u, texture.v);
    has[0] = wanted[0];
  }
  if (wanted[1] >= 0 && has[1] < 0) {
    builder_.set_normal(vertex, normals_[static_cast<size_t>(wanted[1])]);
    has[1] = wanted[1];
  }
  return true;
}

}  // namespace diaphane::readers

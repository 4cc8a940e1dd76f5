// Meshes of the SceneStore.
#include "scene/children.h"
#include "scene/mesh_memory.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

absl::Status too_many(std::string_view field, uint64_t count, uint64_t limit) {
  return base::field_error(absl::StatusCode::kResourceExhausted,
                           {std::string(field), fmt::format("{}", count), fmt::format("at most {}", limit)});
}

// The field that carries a mesh's material in every request.
constexpr std::string_view kMaterialField = "mesh.material";

absl::Status check_material(const SceneSnapshot& scene, const Reference& material) {
  const absl::StatusOr<std::string> parent = scene_of_child(material, Collection::kMaterials);
  if (!parent.ok()) return parent.status();
  if (*parent != scene.name) {
    return base::invalid_field(material.field, fmt::format("a material of {}", scene.name), material.name);
  }
  if (find_child(scene.materials, material.name) == scene.materials.end()) return not_found(material, "material");
  return absl::OkStatus();
}

absl::Status check_vertex_count(const Mesh& mesh, size_t vertex_count) {
  if (vertex_count == mesh.topology->vertex_count) return absl::OkStatus();
  return base::invalid_field("vertex_count", fmt::format("the mesh's {}", mesh.topology->vertex_count),
                             static_cast<double>(vertex_count));
}

}  // namespace

absl::StatusOr<Reservation> SceneStore::reserve_mesh(const Reference& parent, const Reference& material,
                                                     const MeshCounts& counts) {
  if (counts.vertex_count > limits_.max_vertices_per_mesh) {
    return too_many("vertex_count", counts.vertex_count, limits_.max_vertices_per_mesh);
  }
  if (counts.triangle_count > limits_.max_triangles_per_mesh) {
    return too_many("triangle_count", counts.triangle_count, limits_.max_triangles_per_mesh);
  }
  const absl::StatusOr<SnapshotPtr> into = scene(parent);
  if (!into.ok()) return into.status();
  if (absl::Status known = check_material(**into, material); !known.ok()) return known;
  absl::Status room = check_room_for_one((*into)->meshes, Collection::kMeshes, limits_.max_meshes_per_scene);
  if (!room.ok()) return room;
  return budget_.reserve(upload_bytes(counts));
}

absl::StatusOr<Changed<Mesh>> SceneStore::create_mesh(const Reference& parent, NewMesh mesh, Reservation reservation) {
  const MeshCounts counts{mesh.topology->vertex_count,
                          static_cast<uint32_t>(mesh.topology->triangles.size()),
                          !mesh.shape->normals.empty(),
                          mesh.attributes != nullptr && !mesh.attributes->texture_coordinates.empty(),
                          mesh.attributes != nullptr && !mesh.attributes->colors.empty(),
                          mesh.morph_targets != nullptr ? static_cast<uint32_t>(mesh.morph_targets->count) : 0};
  reservation.shrink_to(topology_bytes(counts) + shape_bytes(counts) + attribute_bytes(counts) + morph_bytes(counts));
  Mesh created{{}, std::move(mesh.material), mesh.scene_from_mesh, {}, {}, 0};
  if (mesh.attributes != nullptr) {
    created.attributes = hold(std::move(mesh.attributes), reservation.split(attribute_bytes(counts)));
  }
  if (mesh.morph_targets != nullptr) {
    created.morph_targets = hold(std::move(mesh.morph_targets), reservation.split(morph_bytes(counts)));
  }
  created.shape = hold(std::move(mesh.shape), reservation.split(shape_bytes(counts)));
  created.topology = hold(std::move(mesh.topology), std::move(reservation));
  const auto scene = mutate(parent, [&](SceneSnapshot& draft) {
    if (absl::Status known = check_material(draft, {kMaterialField, created.material}); !known.ok()) return known;
    absl::Status room = check_room_for_one(draft.meshes, Collection::kMeshes, limits_.max_meshes_per_scene);
    if (!room.ok()) return room;
    created.name = make_child_name(draft.name, Collection::kMeshes, draft.revision);
    created.positions_revision = draft.revision;
    draft.meshes.push_back(std::make_shared<const Mesh>(created));
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return Changed<Mesh>{std::move(created), (*scene)->revision};
}

absl::StatusOr<Mesh> SceneStore::mesh(const Reference& mesh) const {
  const auto scene = parent_of(mesh, Collection::kMeshes);
  if (!scene.ok()) return scene.status();
  const auto found = find_child((*scene)->meshes, mesh.name);
  if (found == (*scene)->meshes.end()) return not_found(mesh, "mesh");
  return **found;
}

absl::StatusOr<Mesh> update_in(SceneSnapshot& draft, const Reference& mesh, const MeshPatch& patch) {
  const auto found = find_child(draft.meshes, mesh.name);
  if (found == draft.meshes.end()) return not_found(mesh, "mesh");
  Mesh updated = **found;
  if (patch.material.has_value()) {
    if (absl::Status known = check_material(draft, {kMaterialField, *patch.material}); !known.ok()) return known;
    updated.material = *patch.material;
  }
  if (patch.scene_from_mesh.has_value()) updated.scene_from_mesh = *patch.scene_from_mesh;
  *found = std::make_shared<const Mesh>(updated);
  return updated;
}

absl::StatusOr<Changed<Mesh>> SceneStore::update_mesh(const Reference& mesh, const MeshPatch& patch) {
  Changed<Mesh> changed;
  const auto scene = mutate_parent(mesh, Collection::kMeshes, [&](SceneSnapshot& draft) {
    absl::StatusOr<Mesh> updated = update_in(draft, mesh, patch);
    if (updated.ok()) changed = {*std::move(updated), draft.revision};
    return updated.status();
  });
  if (!scene.ok()) return scene.status();
  return changed;
}

absl::StatusOr<uint64_t> SceneStore::delete_mesh(const Reference& mesh) {
  const auto scene = mutate_parent(mesh, Collection::kMeshes, [&](SceneSnapshot& draft) {
    const auto found = find_child(draft.meshes, mesh.name);
    if (found == draft.meshes.end()) return not_found(mesh, "mesh");
    draft.meshes.erase(found);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return (*scene)->revision;
}

absl::StatusOr<Reservation> SceneStore::reserve_positions(const Reference& mesh, uint32_t vertex_count,
                                                          bool has_normals) {
  const absl::StatusOr<Mesh> found = this->mesh(mesh);
  if (!found.ok()) return found.status();
  if (absl::Status same = check_vertex_count(*found, vertex_count); !same.ok()) return same;
  return budget_.reserve(positions_upload_bytes({vertex_count, 0, has_normals}));
}

absl::StatusOr<Changed<Mesh>> SceneStore::replace_positions(const Reference& mesh,
                                                            std::shared_ptr<const geometry::MeshShape> shape,
                                                            Reservation reservation) {
  const size_t vertex_count = shape->positions.size();
  reservation.shrink_to(shape_bytes({static_cast<uint32_t>(vertex_count), 0, !shape->normals.empty()}));
  const auto held = hold(std::move(shape), std::move(reservation));
  Changed<Mesh> changed;
  const auto scene = mutate_parent(mesh, Collection::kMeshes, [&](SceneSnapshot& draft) {
    const auto found = find_child(draft.meshes, mesh.name);
    if (found == draft.meshes.end()) return not_found(mesh, "mesh");
    if (absl::Status same = check_vertex_count(**found, vertex_count); !same.ok()) return same;
    Mesh updated = **found;
    updated.shape = held;
    updated.positions_revision = draft.revision;
    *found = std::make_shared<const Mesh>(updated);
    changed = {std::move(updated), draft.revision};
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return changed;
}

}  // namespace diaphane::scene

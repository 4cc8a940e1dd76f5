// Edits of the SceneStore: changes that go together.
#include <algorithm>

#include "scene/children.h"
#include "scene/mesh_memory.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

/// A mesh's shape with some of its positions new; its normals, where they were given, are no more.
absl::StatusOr<geometry::MeshShape> moved(const Mesh& mesh, PositionsPatch& patch) {
  const uint32_t vertex_count = mesh.topology->vertex_count;
  const std::vector<glm::vec3>& rest = mesh.topology->uploaded_positions;
  if (patch.indices.empty() && patch.positions.size() == vertex_count) {
    geometry::MeshShape shape{std::move(patch.positions), {}};
    if (!patch.displacements) return shape;
    for (size_t i = 0; i < rest.size(); ++i) shape.positions[i] += rest[i];
    return shape;
  }
  if (patch.indices.empty()) {
    return base::invalid_field("positions", fmt::format("one for each of the mesh's {} vertices", vertex_count),
                               static_cast<double>(patch.positions.size()));
  }
  geometry::MeshShape shape{mesh.shape->positions, {}};
  for (size_t i = 0; i < patch.indices.size(); ++i) {
    if (patch.indices[i] >= vertex_count) {
      return base::invalid_field(fmt::format("positions.indices[{}]", i), fmt::format("0..{}", vertex_count - 1),
                                 patch.indices[i]);
    }
    const uint32_t vertex = patch.indices[i];
    shape.positions[vertex] = patch.displacements ? rest[vertex] + patch.positions[i] : patch.positions[i];
  }
  return shape;
}

absl::StatusOr<geometry::MeshShape> morphed(const Mesh& mesh, const WeightsPatch& patch) {
  const size_t count = mesh.morph_targets != nullptr ? mesh.morph_targets->count : 0;
  if (count == 0) return base::invalid_field("weights.mesh", "a mesh with morph targets", mesh.name);
  if (patch.weights.size() != count) {
    return base::invalid_field("weights.weights", fmt::format("one for each of the mesh's {} morph targets", count),
                               static_cast<double>(patch.weights.size()));
  }
  geometry::MeshShape shape{geometry::morphed(mesh.topology->uploaded_positions, *mesh.morph_targets, patch.weights),
                            {}};
  if (absl::Status finite = geometry::check_finite(shape.positions, "weights.weights"); !finite.ok()) return finite;
  return shape;
}

/// Whether a change makes a new shape.
bool reshapes(const SceneChange& change) {
  return std::holds_alternative<PositionsPatch>(change.patch) || std::holds_alternative<WeightsPatch>(change.patch) ||
         std::holds_alternative<SpherePatch>(change.patch);
}

/// What a draft's change is applied to, and with.
struct Draft {
  SceneSnapshot& scene;
  const std::string& name;
  Reservation& reservation;

  absl::Status operator()(PositionsPatch& patch) const {
    const auto found = find_child(scene.meshes, name);
    if (found == scene.meshes.end()) return not_found({"positions.mesh", name}, "mesh");
    return take(found, moved(**found, patch));
  }
  absl::Status operator()(const WeightsPatch& patch) const {
    const auto found = find_child(scene.meshes, name);
    if (found == scene.meshes.end()) return not_found({"weights.mesh", name}, "mesh");
    return take(found, morphed(**found, patch));
  }
  absl::Status operator()(const SpherePatch& patch) const {
    const auto found = find_child(scene.meshes, name);
    if (found == scene.meshes.end()) return not_found({"sphere.mesh", name}, "mesh");
    return take(found, geometry::MeshShape{
                           geometry::morphed_to_sphere((*found)->topology->uploaded_positions, patch.amount), {}});
  }
  /// Gives the mesh at `found` its shape.
  absl::Status take(std::vector<std::shared_ptr<const Mesh>>::iterator found,
                    absl::StatusOr<geometry::MeshShape> shape) const {
    if (!shape.ok()) return shape.status();
    Mesh updated = **found;
    const uint64_t bytes = shape_bytes({updated.topology->vertex_count, 0, false});
    updated.shape = hold(std::make_shared<const geometry::MeshShape>(*std::move(shape)), reservation.split(bytes));
    updated.positions_revision = scene.revision;
    *found = std::make_shared<const Mesh>(std::move(updated));
    return absl::OkStatus();
  }
  absl::Status operator()(const MeshPatch& patch) const {
    return update_in(scene, {"mesh.name", name}, patch).status();
  }
  absl::Status operator()(const MaterialPatch& patch) const {
    return update_in(scene, {"material.name", name}, patch).status();
  }
  absl::Status operator()(const LightPatch& patch) const {
    return update_in(scene, {"light.name", name}, patch).status();
  }
  absl::Status operator()(const EnvironmentPatch& patch) const {
    if (name != make_environment_name(scene.name)) return not_found({"environment.name", name}, "environment");
    return update_in(scene, {"environment.name", name}, patch).status();
  }
};

}  // namespace

absl::StatusOr<uint64_t> SceneStore::apply(const Reference& scene, std::vector<SceneChange> changes) {
  const absl::StatusOr<SnapshotPtr> before = this->scene(scene);
  if (!before.ok()) return before.status();
  // Counted before the lock, of the meshes that are there; one that comes in between has the same number of vertices or
  // another name.
  uint64_t bytes = 0;
  for (const SceneChange& change : changes) {
    if (!reshapes(change)) continue;
    const auto found = find_child((*before)->meshes, change.name);
    if (found != (*before)->meshes.end()) bytes += shape_bytes({(*found)->topology->vertex_count, 0, false});
  }
  absl::StatusOr<Reservation> reservation = budget_.reserve(bytes);
  if (!reservation.ok()) return reservation.status();
  const auto applied = mutate(scene, [&](SceneSnapshot& draft) {
    for (size_t i = 0; i < changes.size(); ++i) {
      absl::Status status = std::visit(Draft{draft, changes[i].name, *reservation}, changes[i].patch);
      if (!status.ok()) return base::within(fmt::format("changes[{}].", i), status);
    }
    return absl::OkStatus();
  });
  if (!applied.ok()) return applied.status();
  return (*applied)->revision;
}

}  // namespace diaphane::scene

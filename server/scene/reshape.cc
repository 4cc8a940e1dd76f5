#include "scene/reshape.h"

#include <algorithm>
#include <utility>

#include "geometry/topology.h"
#include "scene/children.h"
#include "scene/mesh_memory.h"

namespace diaphane::scene {
namespace {

/// Whether a change fits its mesh.
struct Check {
  const Mesh& mesh;

  absl::Status operator()(const PositionsPatch& patch) const {
    const uint32_t vertex_count = mesh.topology->vertex_count;
    if (patch.indices.empty()) {
      if (patch.positions.size() == vertex_count) return absl::OkStatus();
      return base::invalid_field("positions", fmt::format("one for each of the mesh's {} vertices", vertex_count),
                                 static_cast<double>(patch.positions.size()));
    }
    const auto beyond =
        std::find_if(patch.indices.begin(), patch.indices.end(), [&](uint32_t index) { return index >= vertex_count; });
    if (beyond == patch.indices.end()) return absl::OkStatus();
    return base::invalid_field(fmt::format("positions.indices[{}]", beyond - patch.indices.begin()),
                               fmt::format("0..{}", vertex_count - 1), *beyond);
  }
  absl::Status operator()(const WeightsPatch& patch) const {
    const size_t count = mesh.morph_targets != nullptr ? mesh.morph_targets->count : 0;
    if (count == 0) return base::invalid_field("weights.mesh", "a mesh with morph targets", mesh.name);
    if (patch.weights.size() == count) return absl::OkStatus();
    return base::invalid_field("weights.weights", fmt::format("one for each of the mesh's {} morph targets", count),
                               static_cast<double>(patch.weights.size()));
  }
  template <typename Other>
  absl::Status operator()(const Other&) const {
    return absl::OkStatus();
  }
};

const char* field_of(const SceneChange& change) {
  if (std::holds_alternative<WeightsPatch>(change.patch)) return "weights";
  return std::holds_alternative<SpherePatch>(change.patch) ? "sphere" : "positions";
}

bool makes_all(const SceneChange& change) {
  const auto* positions = std::get_if<PositionsPatch>(&change.patch);
  return positions == nullptr || positions->indices.empty();
}

/// A whole shape of `mesh`; positions are moved out of the change.
std::vector<glm::vec3> made(const Mesh& mesh, SceneChange& change) {
  const std::vector<glm::vec3>& rest = mesh.topology->uploaded_positions;
  if (const auto* weights = std::get_if<WeightsPatch>(&change.patch)) {
    return geometry::morphed(rest, *mesh.morph_targets, weights->weights);
  }
  if (const auto* sphere = std::get_if<SpherePatch>(&change.patch)) {
    return geometry::morphed_to_sphere(rest, sphere->amount);
  }
  auto& patch = std::get<PositionsPatch>(change.patch);
  std::vector<glm::vec3> positions = std::move(patch.positions);
  if (!patch.displacements) return positions;
  for (size_t i = 0; i < rest.size(); ++i) positions[i] += rest[i];
  return positions;
}

/// Sums of what is in range need not be; what came as it is was looked at.
absl::Status check_results(const SceneChange& change, std::span<const glm::vec3> positions) {
  const auto* patch = std::get_if<PositionsPatch>(&change.patch);
  if (patch != nullptr && !patch->displacements) return absl::OkStatus();
  if (geometry::check_finite(positions, "").ok()) return absl::OkStatus();
  const auto beyond = std::find_if(positions.begin(), positions.end(), [](const glm::vec3& p) {
    return !geometry::check_finite({&p, 1}, "").ok();
  });
  return base::invalid_field(field_of(change), "what leads to positions that are finite, within ±1e18",
                             fmt::format("one at ({:g}, {:g}, {:g})", beyond->x, beyond->y, beyond->z));
}

}  // namespace

bool reshapes(const SceneChange& change) {
  return std::holds_alternative<PositionsPatch>(change.patch) || std::holds_alternative<WeightsPatch>(change.patch) ||
         std::holds_alternative<SpherePatch>(change.patch);
}

void Reshaping::fail(size_t i, absl::Status status) {
  if (i >= failed_) return;
  failed_ = i;
  status_ = std::move(status);
}

absl::Status Reshaping::plan_one(const SceneSnapshot& scene, size_t i) {
  const auto found = find_child(scene.meshes, changes_[i].name);
  if (found == scene.meshes.end()) {
    return not_found({fmt::format("{}.mesh", field_of(changes_[i])), changes_[i].name}, "mesh");
  }
  if (absl::Status status = std::visit(Check{**found}, changes_[i].patch); !status.ok()) return status;
  auto reshaped =
      std::find_if(meshes_.begin(), meshes_.end(), [&](const Reshaped& known) { return known.mesh == *found; });
  if (reshaped == meshes_.end()) reshaped = meshes_.insert(meshes_.end(), Reshaped{*found, {}});
  if (makes_all(changes_[i])) {
    reshaped->changes.clear();
    reshaped->is_whole = true;
  }
  reshaped->changes.push_back(i);
  return absl::OkStatus();
}

absl::StatusOr<geometry::MeshShape> Reshaping::make(const Reshaped& reshaped, size_t* at) const {
  const Mesh& mesh = *reshaped.mesh;
  // Normals, where they were given, are no more.
  geometry::MeshShape shape;
  if (!reshaped.is_whole) shape.positions = mesh.shape->positions;
  for (const size_t i : reshaped.changes) {
    *at = i;
    if (makes_all(changes_[i])) {
      shape.positions = made(mesh, changes_[i]);
      if (absl::Status status = check_results(changes_[i], shape.positions); !status.ok()) return status;
      continue;
    }
    const auto& patch = std::get<PositionsPatch>(changes_[i].patch);
    for (size_t k = 0; k < patch.indices.size(); ++k) {
      const uint32_t vertex = patch.indices[k];
      glm::vec3 position = patch.positions[k];
      if (patch.displacements) position += mesh.topology->uploaded_positions[vertex];
      if (absl::Status status = check_results(changes_[i], {&position, 1}); !status.ok()) return status;
      shape.positions[vertex] = position;
    }
  }
  return shape;
}

absl::Status Reshaping::work_out(Reshaped& reshaped) {
  const uint64_t bytes = shape_bytes({reshaped.mesh->topology->vertex_count, 0, false});
  absl::StatusOr<Reservation> reservation = budget_.reserve(bytes);
  if (!reservation.ok()) return reservation.status();
  size_t at = 0;
  absl::StatusOr<geometry::MeshShape> shape = make(reshaped, &at);
  if (!shape.ok()) {
    fail(at, shape.status());
    return absl::OkStatus();
  }
  reshaped.shape = hold(std::make_shared<const geometry::MeshShape>(*std::move(shape)), *std::move(reservation));
  return absl::OkStatus();
}

absl::Status Reshaping::follow(const SceneSnapshot& scene) {
  if (!is_planned_) {
    is_planned_ = true;
    for (size_t i = 0; i < changes_.size() && status_.ok(); ++i) {
      if (!reshapes(changes_[i])) continue;
      if (absl::Status status = plan_one(scene, i); !status.ok()) fail(i, std::move(status));
    }
  }
  for (Reshaped& reshaped : meshes_) {
    const auto found = find_child(scene.meshes, reshaped.mesh->name);
    if (found == scene.meshes.end()) {
      const SceneChange& change = changes_[reshaped.changes.front()];
      fail(reshaped.changes.front(), not_found({fmt::format("{}.mesh", field_of(change)), change.name}, "mesh"));
      continue;
    }
    const bool is_done = reshaped.shape != nullptr && (reshaped.is_whole || reshaped.mesh->shape == (*found)->shape);
    reshaped.mesh = *found;
    if (is_done) continue;
    reshaped.shape.reset();
    if (absl::Status room = work_out(reshaped); !room.ok()) return room;
  }
  return absl::OkStatus();
}

bool Reshaping::put_into(SceneSnapshot& draft) const {
  for (const Reshaped& reshaped : meshes_) {
    const auto found = find_child(draft.meshes, reshaped.mesh->name);
    if (found == draft.meshes.end()) return false;
    if (!reshaped.is_whole && (*found)->shape != reshaped.mesh->shape) return false;
    Mesh updated = **found;
    updated.shape = reshaped.shape;
    updated.positions_revision = draft.revision;
    *found = std::make_shared<const Mesh>(std::move(updated));
  }
  return true;
}

}  // namespace diaphane::scene

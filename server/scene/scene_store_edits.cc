// Edits of the SceneStore: changes that go together.
#include "scene/children.h"
#include "scene/reshape.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

/// What a draft's change is applied to, and with. Shapes are worked out before.
struct Draft {
  SceneSnapshot& scene;
  const std::string& name;

  absl::Status operator()(const PositionsPatch&) const { return absl::OkStatus(); }
  absl::Status operator()(const WeightsPatch&) const { return absl::OkStatus(); }
  absl::Status operator()(const SpherePatch&) const { return absl::OkStatus(); }
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
  Reshaping reshaping(changes, budget_);
  while (true) {
    const absl::StatusOr<SnapshotPtr> before = this->scene(scene);
    if (!before.ok()) return before.status();
    if (absl::Status room = reshaping.follow(**before); !room.ok()) return room;
    bool overtaken = false;
    const auto applied = mutate(scene, [&](SceneSnapshot& draft) {
      for (size_t i = 0; i < changes.size(); ++i) {
        absl::Status status = reshaping.status_of(i);
        if (status.ok()) status = std::visit(Draft{draft, changes[i].name}, changes[i].patch);
        if (!status.ok()) return base::within(fmt::format("changes[{}].", i), status);
      }
      overtaken = !reshaping.put_into(draft);
      return overtaken ? absl::AbortedError("overtaken") : absl::OkStatus();
    });
    // Whoever overtook it got on; then it is its turn.
    if (overtaken) continue;
    if (!applied.ok()) return applied.status();
    return (*applied)->revision;
  }
}

}  // namespace diaphane::scene

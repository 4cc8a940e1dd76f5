// The environment of a scene.
#include "scene/children.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

constexpr uint64_t kPixelBytes = sizeof(glm::vec3);

}  // namespace

absl::StatusOr<Reservation> SceneStore::reserve_environment(const Reference& parent, uint32_t width_px,
                                                            uint32_t height_px) {
  if (const absl::StatusOr<SnapshotPtr> into = scene(parent); !into.ok()) return into.status();
  // The payload, the map, and the copy that lamps are taken out of.
  return budget_.reserve(3 * kPixelBytes * width_px * height_px);
}

absl::StatusOr<Changed<EnvironmentPtr>> SceneStore::set_environment(const Reference& parent, Environment environment,
                                                                    Reservation reservation) {
  reservation.shrink_to(kPixelBytes * environment.map->radiance.size());
  environment.map = hold(std::move(environment.map), std::move(reservation));
  Changed<EnvironmentPtr> changed;
  const auto scene = mutate(parent, [&](SceneSnapshot& draft) {
    environment.name = make_environment_name(draft.name);
    draft.environment = std::make_shared<const Environment>(std::move(environment));
    changed = {draft.environment, draft.revision};
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return changed;
}

absl::StatusOr<EnvironmentPtr> SceneStore::environment(const Reference& environment) const {
  const absl::StatusOr<std::string> name = scene_of_environment(environment);
  if (!name.ok()) return name.status();
  const absl::StatusOr<SnapshotPtr> of = scene({environment.field, *name});
  if (!of.ok()) return of.status();
  if ((*of)->environment == nullptr) return not_found(environment, "environment");
  return (*of)->environment;
}

absl::StatusOr<EnvironmentPtr> update_in(SceneSnapshot& draft, const Reference& environment,
                                         const EnvironmentPatch& patch) {
  if (draft.environment == nullptr) return not_found(environment, "environment");
  Environment updated = *draft.environment;
  if (patch.rotation_deg.has_value()) updated.rotation_deg = *patch.rotation_deg;
  if (patch.intensity.has_value()) updated.intensity = *patch.intensity;
  if (patch.occlusion.has_value()) updated.occlusion = *patch.occlusion;
  draft.environment = std::make_shared<const Environment>(std::move(updated));
  return draft.environment;
}

absl::StatusOr<Changed<EnvironmentPtr>> SceneStore::update_environment(const Reference& environment,
                                                                       const EnvironmentPatch& patch) {
  const absl::StatusOr<std::string> name = scene_of_environment(environment);
  if (!name.ok()) return name.status();
  Changed<EnvironmentPtr> changed;
  const auto scene = mutate({environment.field, *name}, [&](SceneSnapshot& draft) {
    absl::StatusOr<EnvironmentPtr> updated = update_in(draft, environment, patch);
    if (updated.ok()) changed = {*std::move(updated), draft.revision};
    return updated.status();
  });
  if (!scene.ok()) return scene.status();
  return changed;
}

absl::StatusOr<uint64_t> SceneStore::delete_environment(const Reference& environment) {
  const absl::StatusOr<std::string> name = scene_of_environment(environment);
  if (!name.ok()) return name.status();
  const auto scene = mutate({environment.field, *name}, [&](SceneSnapshot& draft) {
    if (draft.environment == nullptr) return not_found(environment, "environment");
    draft.environment.reset();
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return (*scene)->revision;
}

}  // namespace diaphane::scene

// Finding, adding and removing the children of a scene's draft. Internal to the room.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "fmt/format.h"
#include "scene/names.h"
#include "scene/scene_store.h"
#include "scene/snapshot.h"

namespace diaphane::scene {

inline const std::string& name_of(const Material& material) { return material.name; }
inline const std::string& name_of(const Texture& texture) { return texture.name; }
inline const std::string& name_of(const Light& light) { return light.name; }
inline const std::string& name_of(const std::shared_ptr<const Mesh>& mesh) { return mesh->name; }

/// The child called `name`, or end().
template <typename Children>
auto find_child(Children& children, std::string_view name) {
  return std::find_if(children.begin(), children.end(), [&](const auto& child) { return name_of(child) == name; });
}

/// RESOURCE_EXHAUSTED when `children` are as many as may be.
template <typename Child>
absl::Status check_room_for_one(const std::vector<Child>& children, Collection collection, uint32_t max_count) {
  if (children.size() < max_count) return absl::OkStatus();
  return base::field_error(absl::StatusCode::kResourceExhausted,
                           {std::string(collection_id(collection)), fmt::format("{}", children.size() + 1),
                            fmt::format("at most {} in a scene", max_count)});
}

// What updates do to a scene's draft; each returns the updated child, or changes nothing.
absl::StatusOr<Mesh> update_in(SceneSnapshot& draft, const Reference& mesh, const MeshPatch& patch);
absl::StatusOr<Material> update_in(SceneSnapshot& draft, const Reference& material, const MaterialPatch& patch);
absl::StatusOr<Light> update_in(SceneSnapshot& draft, const Reference& light, const LightPatch& patch);
absl::StatusOr<std::shared_ptr<const Environment>> update_in(SceneSnapshot& draft, const Reference& environment,
                                                             const EnvironmentPatch& patch);

}  // namespace diaphane::scene

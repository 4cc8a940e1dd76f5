// Textures of the SceneStore.
#include "scene/children.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

constexpr uint64_t kPixelBytes = 4;

/// What the render thread makes of it, mip maps included.
constexpr uint64_t gpu_bytes(uint64_t bytes) { return bytes + bytes / 3; }

}  // namespace

absl::StatusOr<Reservation> SceneStore::reserve_texture(const Reference& parent, uint32_t width_px,
                                                        uint32_t height_px) {
  const absl::StatusOr<SnapshotPtr> into = scene(parent);
  if (!into.ok()) return into.status();
  absl::Status room = check_room_for_one((*into)->textures, Collection::kTextures, limits_.max_textures_per_scene);
  if (!room.ok()) return room;
  const uint64_t bytes = kPixelBytes * width_px * height_px;
  return budget_.reserve(2 * bytes + gpu_bytes(bytes));  // the payload and the pixels
}

absl::StatusOr<Changed<Texture>> SceneStore::create_texture(const Reference& parent, Texture texture,
                                                            Reservation reservation) {
  const uint64_t bytes = texture.pixels->rgba.size();
  reservation.shrink_to(bytes + gpu_bytes(bytes));
  texture.pixels = hold(std::move(texture.pixels), std::move(reservation));
  const auto scene = mutate(parent, [&](SceneSnapshot& draft) {
    absl::Status room = check_room_for_one(draft.textures, Collection::kTextures, limits_.max_textures_per_scene);
    if (!room.ok()) return room;
    texture.name = make_child_name(draft.name, Collection::kTextures, draft.revision);
    draft.textures.push_back(texture);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return Changed<Texture>{std::move(texture), (*scene)->revision};
}

absl::StatusOr<Texture> SceneStore::texture(const Reference& texture) const {
  const auto scene = parent_of(texture, Collection::kTextures);
  if (!scene.ok()) return scene.status();
  const auto found = find_child((*scene)->textures, texture.name);
  if (found == (*scene)->textures.end()) return not_found(texture, "texture");
  return *found;
}

absl::StatusOr<uint64_t> SceneStore::delete_texture(const Reference& texture) {
  const auto scene = mutate_parent(texture, Collection::kTextures, [&](SceneSnapshot& draft) {
    const auto found = find_child(draft.textures, texture.name);
    if (found == draft.textures.end()) return not_found(texture, "texture");
    for (const Material& material : draft.materials) {
      const SurfaceTextures& used = material.textures;
      if (used.albedo == texture.name || used.normal == texture.name || used.roughness == texture.name) {
        return base::field_error(absl::StatusCode::kFailedPrecondition,
                                 {std::string(texture.field), std::string(texture.name),
                                  fmt::format("used by no material (is used by {})", material.name)});
      }
    }
    draft.textures.erase(found);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return (*scene)->revision;
}

}  // namespace diaphane::scene

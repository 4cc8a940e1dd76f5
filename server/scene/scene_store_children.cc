// Materials and lights of the SceneStore.
#include "scene/children.h"
#include "scene/scene_store.h"

namespace diaphane::scene {
namespace {

absl::Status apply_patch(const LightPatch& patch, LightKind& light) {
  if (patch.kind.has_value()) light = *patch.kind;
  if (!patch.position.has_value() && !patch.intensity_w_sr.has_value()) return absl::OkStatus();
  auto* point = std::get_if<PointLight>(&light);
  if (point == nullptr) return absl::FailedPreconditionError("light.point: the light is of another kind");
  if (patch.position.has_value()) point->position = *patch.position;
  if (patch.intensity_w_sr.has_value()) point->intensity_w_sr = *patch.intensity_w_sr;
  return absl::OkStatus();
}

void set_form(Material* material, const optics::MaterialForm& form, optics::Profile profile) {
  optics::ResolvedMaterial resolved = optics::resolve(form, profile);
  material->form = form;
  material->coefficients = resolved.coefficients;
  material->warnings = std::move(resolved.warnings);
}

absl::Status check_texture(const SceneSnapshot& scene, const Reference& texture, bool may_be_srgb) {
  if (texture.name.empty()) return absl::OkStatus();
  const absl::StatusOr<std::string> parent = scene_of_child(texture, Collection::kTextures);
  if (!parent.ok()) return parent.status();
  if (*parent != scene.name) {
    return base::invalid_field(texture.field, fmt::format("a texture of {}", scene.name), texture.name);
  }
  const Texture* found = texture_of(scene, std::string(texture.name));
  if (found == nullptr) return not_found(texture, "texture");
  if (may_be_srgb || !found->sampling.srgb) return absl::OkStatus();
  return base::invalid_field(texture.field, "a texture that is not srgb", texture.name);
}

absl::Status check_textures(const SceneSnapshot& scene, const SurfaceTextures& textures) {
  absl::Status status = check_texture(scene, {"material.textures.albedo", textures.albedo}, true);
  if (status.ok()) status = check_texture(scene, {"material.textures.normal", textures.normal}, false);
  if (status.ok()) status = check_texture(scene, {"material.textures.roughness", textures.roughness}, false);
  return status;
}

}  // namespace

template <typename Child, typename Patch>
absl::StatusOr<Changed<Child>> SceneStore::update_child(const Reference& child, Collection collection,
                                                        const Patch& patch) {
  Changed<Child> changed;
  const auto scene = mutate_parent(child, collection, [&](SceneSnapshot& draft) {
    absl::StatusOr<Child> updated = update_in(draft, child, patch);
    if (updated.ok()) changed = {*std::move(updated), draft.revision};
    return updated.status();
  });
  if (!scene.ok()) return scene.status();
  return changed;
}

absl::StatusOr<Changed<Material>> SceneStore::create_material(const Reference& parent, const NewMaterial& material) {
  Material created;
  set_form(&created, material.form, material.profile);
  created.coat = material.coat;
  created.textures = material.textures;
  const auto scene = mutate(parent, [&](SceneSnapshot& draft) {
    if (absl::Status known = check_textures(draft, created.textures); !known.ok()) return known;
    absl::Status room = check_room_for_one(draft.materials, Collection::kMaterials, limits_.max_materials_per_scene);
    if (!room.ok()) return room;
    created.name = make_child_name(draft.name, Collection::kMaterials, draft.revision);
    draft.materials.push_back(created);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return Changed<Material>{std::move(created), (*scene)->revision};
}

absl::StatusOr<Material> SceneStore::material(const Reference& material) const {
  const auto scene = parent_of(material, Collection::kMaterials);
  if (!scene.ok()) return scene.status();
  const auto found = find_child((*scene)->materials, material.name);
  if (found == (*scene)->materials.end()) return not_found(material, "material");
  return *found;
}

absl::StatusOr<Material> update_in(SceneSnapshot& draft, const Reference& material, const MaterialPatch& patch) {
  const auto found = find_child(draft.materials, material.name);
  if (found == draft.materials.end()) return not_found(material, "material");
  if (patch.textures.has_value()) {
    if (absl::Status known = check_textures(draft, *patch.textures); !known.ok()) return known;
    found->textures = *patch.textures;
  }
  set_form(&*found, patch.form.value_or(found->form), patch.profile.value_or(found->coefficients.profile));
  if (patch.coat.has_value()) found->coat = *patch.coat;
  return *found;
}

absl::StatusOr<Changed<Material>> SceneStore::update_material(const Reference& material, const MaterialPatch& patch) {
  return update_child<Material>(material, Collection::kMaterials, patch);
}

absl::StatusOr<uint64_t> SceneStore::delete_material(const Reference& material) {
  const auto scene = mutate_parent(material, Collection::kMaterials, [&](SceneSnapshot& draft) {
    const auto found = find_child(draft.materials, material.name);
    if (found == draft.materials.end()) return not_found(material, "material");
    for (const auto& mesh : draft.meshes) {
      if (mesh->material == material.name) {
        return base::field_error(absl::StatusCode::kFailedPrecondition,
                                 {std::string(material.field), std::string(material.name),
                                  fmt::format("used by no mesh (is used by {})", mesh->name)});
      }
    }
    draft.materials.erase(found);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return (*scene)->revision;
}

absl::StatusOr<Changed<Light>> SceneStore::create_light(const Reference& parent, const LightKind& light) {
  Light created{{}, light};
  const auto scene = mutate(parent, [&](SceneSnapshot& draft) {
    absl::Status room = check_room_for_one(draft.lights, Collection::kLights, limits_.max_lights_per_scene);
    if (!room.ok()) return room;
    created.name = make_child_name(draft.name, Collection::kLights, draft.revision);
    draft.lights.push_back(created);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return Changed<Light>{std::move(created), (*scene)->revision};
}

absl::StatusOr<Light> SceneStore::light(const Reference& light) const {
  const auto scene = parent_of(light, Collection::kLights);
  if (!scene.ok()) return scene.status();
  const auto found = find_child((*scene)->lights, light.name);
  if (found == (*scene)->lights.end()) return not_found(light, "light");
  return *found;
}

absl::StatusOr<Light> update_in(SceneSnapshot& draft, const Reference& light, const LightPatch& patch) {
  const auto found = find_child(draft.lights, light.name);
  if (found == draft.lights.end()) return not_found(light, "light");
  if (absl::Status applied = apply_patch(patch, found->kind); !applied.ok()) return applied;
  return *found;
}

absl::StatusOr<Changed<Light>> SceneStore::update_light(const Reference& light, const LightPatch& patch) {
  return update_child<Light>(light, Collection::kLights, patch);
}

absl::StatusOr<uint64_t> SceneStore::delete_light(const Reference& light) {
  const auto scene = mutate_parent(light, Collection::kLights, [&](SceneSnapshot& draft) {
    const auto found = find_child(draft.lights, light.name);
    if (found == draft.lights.end()) return not_found(light, "light");
    draft.lights.erase(found);
    return absl::OkStatus();
  });
  if (!scene.ok()) return scene.status();
  return (*scene)->revision;
}

}  // namespace diaphane::scene

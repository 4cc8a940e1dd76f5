#include "scene_upload.h"

#include <algorithm>
#include <string>
#include <utility>

#include "fmt/format.h"
#include "status.h"

namespace diaphane::cli {
namespace {

// A preset with another refractive index is free coefficients to the server.
absl::Status resolve_refractive_index(const Client& client, RenderPlan* plan) {
  if (!plan->refractive_index) return absl::OkStatus();
  absl::StatusOr<std::vector<MaterialPreset>> presets = client.material_presets();
  if (!presets.ok()) return presets.status();
  const std::string& name = std::get<std::string>(plan->materials.front().material.model);
  for (MaterialPreset& preset : *presets) {
    if (preset.name != name) continue;
    preset.coefficients.refractive_index = *plan->refractive_index;
    plan->materials.front().material.model = preset.coefficients;
    return absl::OkStatus();
  }
  return absl::NotFoundError(fmt::format("--material: must be a preset (see 'diaphane materials'), got '{}'", name));
}

absl::StatusOr<std::vector<TextureHandle>> upload_textures(const Scene& scene, const RenderPlan& plan,
                                                           Progress& progress) {
  std::vector<TextureHandle> handles;
  for (const TextureData& texture : plan.textures) {
    progress.step(fmt::format("uploading texture {} of {}", handles.size() + 1, plan.textures.size()));
    absl::StatusOr<TextureHandle> handle = scene.add_texture(texture);
    if (!handle.ok()) return handle.status();
    handles.push_back(*std::move(handle));
  }
  return handles;
}

/// The meshes, in the plan's order.
absl::StatusOr<std::vector<MeshHandle>> fill_scene(const Scene& scene, const RenderPlan& plan, Progress& progress) {
  const absl::StatusOr<std::vector<TextureHandle>> textures = upload_textures(scene, plan, progress);
  if (!textures.ok()) return textures.status();
  const auto picture = [&](const std::optional<size_t>& index) {
    return index ? std::optional((*textures)[*index]) : std::nullopt;
  };
  std::vector<MaterialHandle> materials;
  for (size_t i = 0; i < plan.materials.size(); ++i) {
    const bool used =
        std::find(plan.material_of_mesh.begin(), plan.material_of_mesh.end(), i) != plan.material_of_mesh.end();
    if (!used) {
      materials.emplace_back();
      continue;
    }
    const PlannedMaterial& planned = plan.materials[i];
    Material material = planned.material;
    material.textures.albedo = picture(planned.albedo);
    material.textures.normal = picture(planned.normal);
    material.textures.roughness = picture(planned.roughness);
    absl::StatusOr<MaterialHandle> handle = scene.add_material(material);
    if (!handle.ok()) return handle.status();
    const absl::StatusOr<MaterialInfo> info = scene.material(*handle);
    if (!info.ok()) return info.status();
    progress.clear();
    for (const std::string& warning : info->warnings) print_note("warning: material: " + warning);
    materials.push_back(*std::move(handle));
  }
  for (const Light& light : plan.lights) {
    if (const auto handle = scene.add_light(light); !handle.ok()) return handle.status();
  }
  if (plan.environment) {
    progress.step("uploading the environment");
    const auto revision = scene.set_environment(*plan.environment, plan.environment_options);
    if (!revision.ok()) return revision.status();
  }
  std::vector<MeshHandle> meshes;
  for (size_t i = 0; i < plan.meshes.size(); ++i) {
    const MeshData& mesh = plan.meshes[i];
    progress.step(
        fmt::format("uploading mesh {} of {} ({} triangles)", i + 1, plan.meshes.size(), mesh.triangles.size() / 3));
    absl::StatusOr<MeshHandle> handle = scene.add_mesh(mesh, {.material = materials[plan.material_of_mesh[i]]});
    if (!handle.ok()) return handle.status();
    meshes.push_back(*std::move(handle));
  }
  return meshes;
}

}  // namespace

absl::StatusOr<UploadedScene> upload_plan(const GlobalOptions& global, RenderPlan* plan, Progress& progress) {
  progress.step(global.server.empty() ? "starting a server" : "connecting");
  absl::StatusOr<Session> session = open_session(global);
  if (!session.ok()) return session.status();
  absl::StatusOr<TemporaryScene> scene = TemporaryScene::create(session->client, plan);
  if (!scene.ok()) return scene.status();
  absl::StatusOr<std::vector<MeshHandle>> meshes = fill_scene(scene->scene(), *plan, progress);
  if (!meshes.ok()) return meshes.status();
  return UploadedScene{*std::move(session), *std::move(scene), *std::move(meshes)};
}

absl::StatusOr<TemporaryScene> TemporaryScene::create(const Client& client, RenderPlan* plan) {
  if (absl::Status status = resolve_refractive_index(client, plan); !status.ok()) return status;
  absl::StatusOr<Scene> scene =
      client.create_scene({.display_name = plan->display_name, .millimetres_per_unit = plan->millimetres_per_unit});
  if (!scene.ok()) return scene.status();
  return TemporaryScene(*std::move(scene));
}

TemporaryScene::~TemporaryScene() {
  if (scene_.has_value()) (void)scene_->remove();
}

TemporaryScene::TemporaryScene(TemporaryScene&& other) noexcept : scene_(std::exchange(other.scene_, std::nullopt)) {}

absl::Status TemporaryScene::remove() { return std::exchange(scene_, std::nullopt)->remove(); }

}  // namespace diaphane::cli

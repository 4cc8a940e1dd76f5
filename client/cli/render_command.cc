#include "render_command.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "diaphane/client.h"
#include "fmt/format.h"
#include "json.h"
#include "output_file.h"
#include "progress.h"
#include "render_plan.h"
#include "session.h"
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

absl::Status fill_scene(const Scene& scene, const RenderPlan& plan, Progress& progress) {
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
  for (size_t i = 0; i < plan.meshes.size(); ++i) {
    const MeshData& mesh = plan.meshes[i];
    progress.step(
        fmt::format("uploading mesh {} of {} ({} triangles)", i + 1, plan.meshes.size(), mesh.triangles.size() / 3));
    const auto handle = scene.add_mesh(mesh, {.material = materials[plan.material_of_mesh[i]]});
    if (!handle.ok()) return handle.status();
  }
  return absl::OkStatus();
}

absl::StatusOr<RenderedFrame> render_scene(const Scene& scene, const RenderPlan& plan, Progress& progress) {
  if (absl::Status status = fill_scene(scene, plan, progress); !status.ok()) return status;
  const std::string what = fmt::format("rendering {}x{}", plan.options.size.width_px, plan.options.size.height_px);
  progress.step(what);
  if (plan.options.settings.technique != Technique::kReference) return scene.render(plan.options);
  return scene.render(plan.options, [&](double share) { progress.bar(what, share); });
}

absl::StatusOr<RenderedFrame> make_frame(const Client& client, RenderPlan* plan, Progress& progress) {
  if (absl::Status status = resolve_refractive_index(client, plan); !status.ok()) return status;
  const absl::StatusOr<Scene> scene =
      client.create_scene({.display_name = plan->display_name, .millimetres_per_unit = plan->millimetres_per_unit});
  if (!scene.ok()) return scene.status();
  absl::StatusOr<RenderedFrame> frame = render_scene(*scene, *plan, progress);
  const absl::Status removed = scene->remove();
  if (frame.ok() && !removed.ok()) return removed;
  return frame;
}

void report(const GlobalOptions& global, const RenderArguments& arguments, const RenderPlan& plan,
            const RenderedFrame& frame) {
  if (global.verbose) {
    for (const StageTime& stage : frame.stages) {
      print_note(fmt::format("{:<10} {:9.2f} ms{}", stage.stage, stage.milliseconds, stage.ran ? "" : "  (slept)"));
    }
  }
  if (!global.json) {
    fmt::print("{}\n", arguments.output);
    return;
  }
  Json json{{"output", arguments.output},
            {"content_type", frame.content_type},
            {"bytes", frame.image.size()},
            {"width_px", frame.size.width_px},
            {"height_px", frame.size.height_px},
            {"millimetres_per_unit", plan.millimetres_per_unit},
            {"camera", to_json(plan.options.camera)},
            {"path", frame.path},
            {"stages", Json::array()}};
  for (const StageTime& stage : frame.stages) json["stages"].push_back(to_json(stage));
  print_json(json);
}

}  // namespace

absl::Status run_render(const GlobalOptions& global, const RenderArguments& arguments) {
  if (arguments.meshes.empty() && arguments.scene_file.empty()) {
    return usage_error("MESH", "give at least one mesh file, or --scene");
  }
  if (arguments.channels && arguments.format != ImageFormat::kExr) {
    return usage_error("--aov", fmt::format("only an .exr has extra channels, got '{}'", arguments.output));
  }
  if (absl::Status status = check_writable(arguments.output); !status.ok()) return status;
  Progress progress;
  progress.step("reading");
  absl::StatusOr<RenderPlan> plan = plan_render(arguments);
  progress.clear();
  if (!plan.ok()) return plan.status();
  for (const std::string& note : plan->notes) print_note(note);

  progress.step(global.server.empty() ? "starting a server" : "connecting");
  const absl::StatusOr<Session> session = open_session(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<RenderedFrame> frame = make_frame(session->client, &*plan, progress);
  progress.clear();
  if (!frame.ok()) return frame.status();
  if (absl::Status status = write_file(arguments.output, frame->image); !status.ok()) return status;
  report(global, arguments, *plan, *frame);
  return absl::OkStatus();
}

}  // namespace diaphane::cli

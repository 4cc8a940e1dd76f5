#include "server_commands.h"

#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "json.h"
#include "session.h"
#include "status.h"

namespace diaphane::cli {
namespace {

std::string text(const Rgb& value) { return fmt::format("{},{},{}", value.r, value.g, value.b); }

absl::StatusOr<Session> open_given_server(const GlobalOptions& global) {
  if (global.server.empty()) return usage_error("--server", "must be given: a private server has no scenes");
  return open_session(global);
}

void print_text(const SceneDescription& description) {
  const SceneInfo& scene = description.scene;
  fmt::print("{}  revision {}  {} mm per unit  {}\n", scene.name, scene.revision, scene.millimetres_per_unit,
             scene.display_name);
  for (const MaterialInfo& info : description.materials) {
    const auto* preset = std::get_if<std::string>(&info.material.model);
    fmt::print("{}  {}  absorption {}  scattering {}  ior {}\n", info.handle.name, preset ? *preset : "free",
               text(info.resolved.absorption_mm), text(info.resolved.reduced_scattering_mm),
               info.resolved.refractive_index);
    for (const std::string& warning : info.warnings) fmt::print("  warning: {}\n", warning);
  }
  for (const LightInfo& info : description.lights) {
    fmt::print("{}  {}\n", info.handle.name, to_json(info.light).dump());
  }
  for (const MeshInfo& info : description.meshes) {
    fmt::print("{}  {} vertices  {} triangles  {}\n", info.handle.name, info.vertex_count, info.triangle_count,
               info.material.name);
  }
}

}  // namespace

absl::Status run_materials(const GlobalOptions& global) {
  const absl::StatusOr<Session> session = open_session(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<std::vector<MaterialPreset>> presets = session->client.material_presets();
  if (!presets.ok()) return presets.status();
  if (global.json) {
    Json json = Json::array();
    for (const MaterialPreset& preset : *presets) json.push_back(to_json(preset));
    print_json(json);
    return absl::OkStatus();
  }
  fmt::print("{:<12} {:<22} {:<18} {:<4} {}\n", "name", "absorption, mm^-1", "scattering, mm^-1", "ior", "source");
  for (const MaterialPreset& preset : *presets) {
    fmt::print("{:<12} {:<22} {:<18} {:<4} {}\n", preset.name, text(preset.coefficients.absorption_mm),
               text(preset.coefficients.reduced_scattering_mm), preset.coefficients.refractive_index, preset.source);
  }
  return absl::OkStatus();
}

absl::Status run_info(const GlobalOptions& global) {
  const absl::StatusOr<Session> session = open_session(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<ServerInfo> info = session->client.info();
  if (!info.ok()) return info.status();
  if (global.json) {
    print_json(to_json(*info));
    return absl::OkStatus();
  }
  fmt::print("version        {}\n", info->version);
  fmt::print("renderer       {}{}\n", info->gl_renderer, info->software_rendering ? "  (software)" : "");
  fmt::print("vendor         {}\n", info->gl_vendor);
  fmt::print("OpenGL         {}\n", info->gl_version);
  fmt::print("chosen because {}\n", info->context_reason);
  fmt::print("techniques     {}\n", fmt::join(info->techniques, " "));
  fmt::print("image formats  {}\n", fmt::join(info->image_formats, " "));
  fmt::print("limits         {} pixels, {} vertices and {} triangles a mesh, {} mesh bytes, {} scenes\n",
             info->max_pixels, info->max_vertices_per_mesh, info->max_triangles_per_mesh, info->max_mesh_bytes,
             info->max_scenes);
  fmt::print("               {} meshes, {} materials and {} lights a scene, {} frames queued\n",
             info->max_meshes_per_scene, info->max_materials_per_scene, info->max_lights_per_scene,
             info->max_queued_frames);
  fmt::print("               {} pixels and {} s a frame by the reference\n", info->max_reference_pixels,
             info->max_reference_seconds);
  return absl::OkStatus();
}

absl::Status run_health(const GlobalOptions& global) {
  if (global.server.empty()) return usage_error("--server", "must be given: a private server serves once it is there");
  const absl::Status status = check_health(global.server, {.stop = global.stop});
  if (absl::IsInvalidArgument(status)) return usage_error("--server", std::string(status.message()));
  if (!status.ok()) return with_exit_code(status, kExitUnavailable);
  if (global.json) {
    print_json({{"serving", true}});
  } else {
    fmt::print("serving\n");
  }
  return absl::OkStatus();
}

absl::Status run_scene_ls(const GlobalOptions& global) {
  const absl::StatusOr<Session> session = open_given_server(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<std::vector<SceneInfo>> scenes = session->client.scenes();
  if (!scenes.ok()) return scenes.status();
  Json json = Json::array();
  for (const SceneInfo& scene : *scenes) {
    if (global.json) {
      json.push_back(to_json(scene));
    } else {
      fmt::print("{}  revision {}  {} meshes  {}\n", scene.name, scene.revision, scene.mesh_count, scene.display_name);
    }
  }
  if (global.json) print_json(json);
  return absl::OkStatus();
}

absl::Status run_scene_show(const GlobalOptions& global, const std::string& scene) {
  const absl::StatusOr<Session> session = open_given_server(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<Scene> opened = session->client.open_scene(scene);
  if (!opened.ok()) return opened.status();
  const absl::StatusOr<SceneDescription> description = opened->describe();
  if (!description.ok()) return description.status();
  if (global.json) {
    print_json(to_json(*description));
  } else {
    print_text(*description);
  }
  return absl::OkStatus();
}

absl::Status run_scene_rm(const GlobalOptions& global, const std::string& scene) {
  const absl::StatusOr<Session> session = open_given_server(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<Scene> opened = session->client.open_scene(scene);
  if (!opened.ok()) return opened.status();
  return opened->remove();
}

}  // namespace diaphane::cli

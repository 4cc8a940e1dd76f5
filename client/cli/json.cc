#include "json.h"

#include <charconv>
#include <cstdio>
#include <variant>

#include "fmt/format.h"

namespace diaphane::cli {

Json to_json(float value) {
  const std::string text = fmt::format("{}", value);
  double shortest = value;
  std::from_chars(text.data(), text.data() + text.size(), shortest);
  return shortest;
}

Json to_json(const Vec3& value) { return {to_json(value.x), to_json(value.y), to_json(value.z)}; }

Json to_json(const Rgb& value) { return {to_json(value.r), to_json(value.g), to_json(value.b)}; }

Json to_json(const PointLight& light) {
  return {{"position", to_json(light.position)},
          {"intensity_w_sr", to_json(light.intensity_w_sr)},
          {"radius_mm", to_json(light.radius_mm)}};
}

Json to_json(const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) return {{"point", to_json(*point)}};
  if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
    return {{"directional",
             {{"direction", to_json(directional->direction)}, {"irradiance", to_json(directional->irradiance)}}}};
  }
  const auto& spot = std::get<SpotLight>(light);
  return {{"spot",
           {{"point", to_json(spot.point)},
            {"direction", to_json(spot.direction)},
            {"inner_angle_deg", to_json(spot.inner_angle_deg)},
            {"outer_angle_deg", to_json(spot.outer_angle_deg)}}}};
}

Json to_json(const Coefficients& coefficients) {
  return {{"absorption_mm", to_json(coefficients.absorption_mm)},
          {"reduced_scattering_mm", to_json(coefficients.reduced_scattering_mm)},
          {"refractive_index", to_json(coefficients.refractive_index)}};
}

Json to_json(const MaterialPreset& preset) {
  Json json{{"name", preset.name}};
  json.update(to_json(preset.coefficients));
  json["source"] = preset.source;
  return json;
}

Json to_json(const ServerInfo& info) {
  return {{"version", info.version},
          {"gl_renderer", info.gl_renderer},
          {"gl_vendor", info.gl_vendor},
          {"gl_version", info.gl_version},
          {"software_rendering", info.software_rendering},
          {"context_reason", info.context_reason},
          {"image_formats", info.image_formats},
          {"techniques", info.techniques},
          {"limits",
           {{"max_pixels", info.max_pixels},
            {"max_reference_pixels", info.max_reference_pixels},
            {"max_reference_seconds", info.max_reference_seconds},
            {"max_vertices_per_mesh", info.max_vertices_per_mesh},
            {"max_triangles_per_mesh", info.max_triangles_per_mesh},
            {"max_scenes", info.max_scenes},
            {"max_meshes_per_scene", info.max_meshes_per_scene},
            {"max_lights_per_scene", info.max_lights_per_scene},
            {"max_materials_per_scene", info.max_materials_per_scene},
            {"max_mesh_bytes", info.max_mesh_bytes},
            {"max_chunk_bytes", info.max_chunk_bytes},
            {"max_queued_frames", info.max_queued_frames}}}};
}

Json to_json(const SceneInfo& scene) {
  return {{"name", scene.name},
          {"display_name", scene.display_name},
          {"millimetres_per_unit", scene.millimetres_per_unit},
          {"revision", scene.revision},
          {"mesh_count", scene.mesh_count},
          {"material_count", scene.material_count},
          {"light_count", scene.light_count}};
}

Json to_json(const SceneDescription& description) {
  Json json = to_json(description.scene);
  json["materials"] = Json::array();
  for (const MaterialInfo& info : description.materials) {
    Json material{{"name", info.handle.name}};
    if (const auto* preset = std::get_if<std::string>(&info.material.model)) material["preset"] = *preset;
    for (const NamedProfile& named : kProfiles) {
      if (named.profile == info.material.profile) material["profile"] = named.name;
    }
    if (info.material.coat) material["coat"] = {{"roughness", info.material.coat->roughness}};
    material["coefficients"] = to_json(info.resolved);
    material["warnings"] = info.warnings;
    json["materials"].push_back(std::move(material));
  }
  json["lights"] = Json::array();
  for (const LightInfo& info : description.lights) {
    json["lights"].push_back(to_json(info.light));
    json["lights"].back()["name"] = info.handle.name;
  }
  json["meshes"] = Json::array();
  for (const MeshInfo& info : description.meshes) {
    Json transform = Json::array();
    for (const float element : info.scene_from_mesh) transform.push_back(to_json(element));
    json["meshes"].push_back({{"name", info.handle.name},
                              {"material", info.material.name},
                              {"scene_from_mesh", std::move(transform)},
                              {"vertex_count", info.vertex_count},
                              {"triangle_count", info.triangle_count},
                              {"has_normals", info.has_normals},
                              {"positions_revision", info.positions_revision}});
  }
  return json;
}

Json to_json(const Camera& camera) {
  return {{"eye", to_json(camera.eye)},
          {"target", to_json(camera.target)},
          {"up", to_json(camera.up)},
          {"fov_y_deg", to_json(camera.fov_y_deg)}};
}

Json to_json(const StageTime& stage) {
  return {{"stage", stage.stage}, {"milliseconds", stage.milliseconds}, {"ran", stage.ran}};
}

void print_json(const Json& json) { fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace)); }

}  // namespace diaphane::cli

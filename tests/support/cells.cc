#include "tests/support/cells.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "diaphane/environment.h"
#include "diffusion/reference.h"
#include "optics/presets.h"

namespace diaphane::testing {

Mesh cell_mesh(const std::string& name, float extent_mm) {
  const auto shared = [](const char* file) {
    auto mesh = read_mesh(shared_path(std::string("data/meshes/") + file));
    if (!mesh) throw std::runtime_error(std::string(file) + " is not there");
    return *mesh;
  };
  Mesh mesh;
  if (name == "bunny") mesh = shared("bunny_closed_72k.ply");
  if (name == "hand") mesh = shared("hand_7k7.ply");
  if (name == "goathead") mesh = shared("demon_standin_goathead_48k.ply");
  if (name == "fertility") mesh = shared("fertility_genus4.off");
  if (name == "torus") mesh = make_torus(7, 3, 160, 64);
  if (name == "cup") mesh = make_cup(7, 20, 2, 0.35f);
  if (name == "plate") mesh = make_box({20, 20, 1}, 20);
  if (name == "cube") mesh = make_box({20, 20, 20}, 20);
  if (mesh.triangles.empty()) throw std::runtime_error("no mesh is called " + name);
  scale_to(mesh, extent_mm);
  return mesh;
}

std::vector<PointLight> cell_lights(const std::string& name, float extent_mm) {
  const float unit = extent_mm / 20;
  std::vector<PointLight> lights;
  if (name == "front") lights = {{{25, 30, 40}, glm::vec3(12000)}};
  if (name == "back") lights = {{{-15, 20, -40}, glm::vec3(12000)}};
  if (name == "two") lights = {{{30, 20, 30}, {12000, 3000, 500}}, {{-30, 10, -20}, {300, 2000, 12000}}};
  if (lights.empty()) throw std::runtime_error("no light is called " + name);
  for (PointLight& light : lights) light.position_mm *= unit;
  return lights;
}

optics::Coefficients cell_material(const std::string& name) {
  const size_t plus = name.find('+');
  const auto preset = optics::find_preset(name.substr(0, plus));
  if (!preset) throw std::runtime_error("no material is called " + name);
  optics::Coefficients material = preset->coefficients;
  if (plus == std::string::npos) return material;
  const std::string profile = name.substr(plus + 1);
  if (profile == "better-dipole") {
    material.profile = optics::Profile::kBetterDipole;
  } else if (profile == "normalized-diffusion") {
    material.profile = optics::Profile::kNormalizedDiffusion;
  } else {
    throw std::runtime_error("no profile is called " + profile);
  }
  return material;
}

std::vector<std::string> environment_names() {
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(shared_path("data/env"))) return names;
  for (const auto& entry : std::filesystem::directory_iterator(shared_path("data/env"))) {
    if (entry.path().extension() == ".hdr") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

optics::LatLongMap environment_map(const std::string& name) {
  const auto file = read_environment_file(shared_path("data/env/" + name + ".hdr"));
  if (!file.ok()) throw std::runtime_error(std::string(file.status().message()));
  optics::LatLongMap map{file->width_px, file->height_px, {}};
  for (const Rgb& pixel : file->radiance) map.radiance.emplace_back(pixel.r, pixel.g, pixel.b);
  return map;
}

Cell make_cell(const std::string& mesh, const std::string& material, const std::string& light, float extent_mm) {
  Cell cell{mesh, material, light, cell_mesh(mesh, extent_mm), cell_material(material), {}, {}};
  const std::vector<std::string> environments = environment_names();
  if (std::find(environments.begin(), environments.end(), light) != environments.end()) {
    cell.irradiance = irradiance_of(optics::analyse(environment_map(light)), cell.material.refractive_index);
    return cell;
  }
  cell.lights = cell_lights(light, extent_mm);
  cell.irradiance = irradiance_of(cell.lights, cell.material.refractive_index);
  return cell;
}

std::vector<glm::vec3> true_radiosity(const Mesh& mesh, const optics::Coefficients& material,
                                      const diffusion::IrradianceAt& irradiance,
                                      const std::vector<glm::vec3>& points_mm, const std::vector<glm::vec3>& normals) {
  const diffusion::ReferenceKernel kernel = diffusion::reference_kernel(optics::make_profile(material));
  const diffusion::SurfelOptions sampling{
      .splits = mesh.triangles.size() > 100000 ? 1u : 2u, .spacing_mm = kernel.spacing_mm, .largest_splits = 200};
  const diffusion::Surfels surfels =
      diffusion::sample_surface(mesh.triangles, mesh.positions_mm, mesh.normals, irradiance, sampling);
  std::vector<glm::vec3> radiosity = *diffusion::reference_radiosity(kernel.spread, surfels, points_mm);
  if (kernel.local == glm::vec3(0)) return radiosity;
  for (size_t i = 0; i < radiosity.size(); ++i) radiosity[i] += kernel.local * irradiance(points_mm[i], normals[i]);
  return radiosity;
}

}  // namespace diaphane::testing

// How far the surface integral is from brute force: mesh × material × light, at random points of the surface.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diffusion/dipole_integral.h"
#include "diffusion/kernel_table.h"
#include "diffusion/reference.h"
#include "diffusion/simd_level.h"
#include "geometry/subdivide.h"
#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"
#include "tests/support/rays.h"

namespace diaphane {
namespace {

using testing::Mesh;

struct Settings {
  std::vector<std::string> meshes = {"bunny", "hand", "goathead", "fertility", "torus", "cup", "plate", "cube"};
  std::vector<std::string> materials = {"marble", "skin1", "wholemilk", "ketchup"};
  std::vector<std::string> lights = {"front", "back", "two"};
  std::string quality = "fine";
  std::vector<float> openings;
  size_t points = 3000;
  float extent_mm = 20;
  float smallest_spacing = 1, largest_spacing = 2;
  std::string cache;
  std::string json;
};

Mesh load(const std::string& name, float extent_mm) {
  const auto shared = [](const char* file) {
    auto mesh = testing::read_mesh(testing::shared_path(std::string("data/meshes/") + file));
    if (!mesh) throw std::runtime_error(std::string(file) + " is not there");
    return *mesh;
  };
  Mesh mesh;
  if (name == "bunny") mesh = shared("bunny_closed_72k.ply");
  if (name == "hand") mesh = shared("hand_7k7.ply");
  if (name == "goathead") mesh = shared("demon_standin_goathead_48k.ply");
  if (name == "fertility") mesh = shared("fertility_genus4.off");
  if (name == "torus") mesh = testing::make_torus(7, 3, 160, 64);
  if (name == "cup") mesh = testing::make_cup(7, 20, 2, 0.35f);
  if (name == "plate") mesh = testing::make_box({20, 20, 1}, 20);
  if (name == "cube") mesh = testing::make_box({20, 20, 20}, 20);
  if (mesh.triangles.empty()) throw std::runtime_error("no mesh is called " + name);
  testing::scale_to(mesh, extent_mm);
  return mesh;
}

std::vector<testing::PointLight> lights_of(const std::string& name, float extent_mm) {
  const float unit = extent_mm / 20;
  std::vector<testing::PointLight> lights;
  if (name == "front") lights = {{{25, 30, 40}, glm::vec3(12000)}};
  if (name == "back") lights = {{{-15, 20, -40}, glm::vec3(12000)}};
  if (name == "two") lights = {{{30, 20, 30}, {12000, 3000, 500}}, {{-30, 10, -20}, {300, 2000, 12000}}};
  if (lights.empty()) throw std::runtime_error("no light is called " + name);
  for (testing::PointLight& light : lights) light.position_mm *= unit;
  return lights;
}

/// The same surface with long edges split for a material.
Mesh subdivided(const Mesh& mesh, float smooth_mm, const Settings& settings) {
  const auto topology = *geometry::build_topology(mesh.positions_mm, mesh.triangles);
  const auto fine = *geometry::subdivide(topology, mesh.positions_mm,
                                         {.smallest_spacing_mm = settings.smallest_spacing * smooth_mm,
                                          .largest_spacing_mm = settings.largest_spacing * smooth_mm});
  Mesh result{mesh.positions_mm, mesh.normals, fine.topology->triangles};
  geometry::extend_positions(fine.parents, result.positions_mm);
  geometry::extend_normals(fine.parents, result.normals);
  return result;
}

std::vector<glm::vec3> truth_of(const Mesh& mesh, const std::vector<glm::vec3>& receivers,
                                const diffusion::IrradianceAt& irradiance, const optics::Dipole& dipole,
                                const std::string& cache_file) {
  std::vector<glm::vec3> truth(receivers.size());
  const auto bytes = static_cast<std::streamsize>(truth.size() * sizeof(glm::vec3));
  if (!cache_file.empty()) {
    std::ifstream file(cache_file, std::ios::binary);
    if (file && file.read(reinterpret_cast<char*>(truth.data()), bytes)) return truth;
  }
  const glm::vec3& l = dipole.mean_free_path_mm;
  const diffusion::SurfelOptions sampling{.splits = mesh.triangles.size() > 100000 ? 1u : 2u,
                                          .spacing_mm = 0.5f * std::min({l.x, l.y, l.z}),
                                          .largest_splits = 200};
  const diffusion::Surfels surfels =
      diffusion::sample_surface(mesh.triangles, mesh.positions_mm, mesh.normals, irradiance, sampling);
  truth = *diffusion::reference_radiosity(dipole, surfels, receivers);
  if (!cache_file.empty())
    std::ofstream(cache_file, std::ios::binary).write(reinterpret_cast<const char*>(truth.data()), bytes);
  return truth;
}

std::vector<glm::vec3> radiosity_of(const Mesh& mesh, const diffusion::IrradianceAt& irradiance,
                                    const optics::Coefficients& material, const Settings& settings) {
  diffusion::DipoleIntegral integral(
      diffusion::build_surface_topology(*geometry::build_topology(mesh.positions_mm, mesh.triangles)));
  const auto light = testing::light_surface(integral.topology(), mesh.positions_mm, mesh.normals, irradiance);
  integral.update_positions(mesh.positions_mm);
  integral.refit_geometry();
  integral.set_irradiance(light.at_triangles, light.at_vertices);
  integral.refit_flux();
  integral.set_material(material);
  std::vector<glm::vec3> radiosity(mesh.positions_mm.size());
  const auto quality = settings.quality == "draft"    ? diffusion::Quality::kDraft
                       : settings.quality == "normal" ? diffusion::Quality::kNormal
                                                      : diffusion::Quality::kFine;
  const diffusion::Openings openings = settings.openings.size() == 2
                                           ? diffusion::Openings{settings.openings[0], settings.openings[1]}
                                           : diffusion::openings_of(quality, material);
  integral.gather(openings, radiosity);
  return radiosity;
}

/// Radiosity of a finer mesh's vertices, interpolated at points of the original.
std::vector<glm::vec3> values_at(const Mesh& mesh, const std::vector<testing::SurfacePoint>& points, const Mesh& fine,
                                 const std::vector<glm::vec3>& radiosity) {
  const testing::MeshRays rays(fine);
  std::vector<glm::vec3> values;
  for (const testing::SurfacePoint& point : points) {
    const glm::uvec3& t = mesh.triangles[point.triangle];
    const glm::vec3 normal = glm::normalize(
        glm::cross(mesh.positions_mm[t.y] - mesh.positions_mm[t.x], mesh.positions_mm[t.z] - mesh.positions_mm[t.x]));
    const auto found = rays.locate(testing::interpolate(mesh, mesh.positions_mm, point), normal);
    if (!found) throw std::runtime_error("a point of the surface was not found on the finer surface");
    values.push_back(testing::interpolate(fine, radiosity, *found));
  }
  return values;
}

struct Cell {
  glm::vec3 error;     ///< RMS over mean
  float worst_of_own;  ///< largest |difference| over the point's own B, where that is above a hundredth of the mean
  float worst_of_mean;
  glm::vec3 worst_at_mm;  ///< where that is
  size_t triangles;
  double spacing;
};

Cell measure(const Mesh& mesh, const std::string& name, const std::string& material_name, const std::string& light,
             const Settings& settings) {
  const optics::Coefficients material = optics::find_preset(material_name).value().coefficients;
  const optics::Dipole dipole = optics::make_dipole(material);
  const glm::vec3 smooth = diffusion::smooth_distance_mm(dipole);
  const float z = std::min({smooth.x, smooth.y, smooth.z});
  const auto irradiance = testing::irradiance_of(lights_of(light, settings.extent_mm), material.refractive_index);
  const Mesh fine = subdivided(mesh, z, settings);
  const auto points = testing::random_points(mesh, settings.points, 1);
  std::vector<glm::vec3> receivers;
  for (const auto& point : points) receivers.push_back(testing::interpolate(mesh, mesh.positions_mm, point));
  const std::string cache =
      settings.cache.empty() ? "" : settings.cache + "/" + name + "." + material_name + "." + light;
  const std::vector<glm::vec3> truth = truth_of(mesh, receivers, irradiance, dipole, cache);
  const std::vector<glm::vec3> radiosity = radiosity_of(fine, irradiance, material, settings);
  const std::vector<glm::vec3> values = values_at(mesh, points, fine, radiosity);

  Cell cell{testing::relative_rms(values, truth), 0, 0, {}, fine.triangles.size(), 0};
  glm::vec3 mean(0);
  for (const glm::vec3& b : truth) mean += b / static_cast<float>(truth.size());
  for (size_t i = 0; i < truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float off = std::abs(values[i][c] - truth[i][c]);
      if (off > cell.worst_of_mean * mean[c]) {
        cell.worst_of_mean = off / mean[c];
        cell.worst_at_mm = receivers[i];
      }
      if (truth[i][c] > 0.01f * mean[c]) cell.worst_of_own = std::max(cell.worst_of_own, off / truth[i][c]);
    }
  }
  double area = 0;
  for (const glm::uvec3& t : fine.triangles) {
    area += 0.5 * glm::length(glm::cross(fine.positions_mm[t.y] - fine.positions_mm[t.x],
                                         fine.positions_mm[t.z] - fine.positions_mm[t.x]));
  }
  cell.spacing = std::sqrt(2 * area / static_cast<double>(fine.triangles.size())) / z;
  return cell;
}

int run(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  std::vector<float> errors;
  std::printf("%-10s %-10s %-6s %9s %6s | %6s %6s %6s | %8s %8s\n", "mesh", "material", "light", "triangles", "s/z",
              "R %", "G %", "B %", "max/mean", "max/own  at mm");
  for (const std::string& name : settings.meshes) {
    const Mesh mesh = load(name, settings.extent_mm);
    for (const std::string& material : settings.materials) {
      for (const std::string& light : settings.lights) {
        const Cell cell = measure(mesh, name, material, light, settings);
        errors.push_back(std::max({cell.error.x, cell.error.y, cell.error.z}));
        std::printf("%-10s %-10s %-6s %9zu %6.2f | %6.2f %6.2f %6.2f | %8.1f %8.1f  %.2f %.2f %.2f\n", name.c_str(),
                    material.c_str(), light.c_str(), cell.triangles, cell.spacing, 100 * cell.error.x,
                    100 * cell.error.y, 100 * cell.error.z, 100 * cell.worst_of_mean, 100 * cell.worst_of_own,
                    cell.worst_at_mm.x, cell.worst_at_mm.y, cell.worst_at_mm.z);
        std::fflush(stdout);
        rows.push_back({{"mesh", name},
                        {"material", material},
                        {"light", light},
                        {"triangles", cell.triangles},
                        {"spacing_over_smooth_distance", cell.spacing},
                        {"relative_rms", {cell.error.x, cell.error.y, cell.error.z}},
                        {"worst_point_over_mean", cell.worst_of_mean},
                        {"worst_point_mm", {cell.worst_at_mm.x, cell.worst_at_mm.y, cell.worst_at_mm.z}},
                        {"worst_point_over_own", cell.worst_of_own}});
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  const float median = errors[errors.size() / 2], worst = errors.back();
  std::printf("worst channel of %zu cells: median %.2f %%, worst %.2f %% (%s)\n", errors.size(), 100 * median,
              100 * worst, diffusion::simd_level().c_str());
  if (!settings.json.empty()) {
    std::ofstream(settings.json) << nlohmann::json{{"simd_level", diffusion::simd_level()},
                                                   {"points", settings.points},
                                                   {"quality", settings.quality},
                                                   {"median", median},
                                                   {"worst", worst},
                                                   {"cells", rows}}
                                        .dump(1)
                                 << "\n";
  }
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Errors of the surface integral against brute force: RMS difference over mean, by channel");
  app.add_option("--meshes", settings.meshes, "bunny hand goathead fertility torus cup plate cube")->delimiter(',');
  app.add_option("--materials", settings.materials, "presets")->delimiter(',');
  app.add_option("--lights", settings.lights, "front back two")->delimiter(',');
  app.add_option("--quality", settings.quality)->check(CLI::IsMember({"draft", "normal", "fine"}));
  app.add_option("--openings", settings.openings, "GROUPS,VERTICES in place of a quality")->delimiter(',')->expected(2);
  app.add_option("--points", settings.points, "random points a cell")->check(CLI::Range(1, 1000000));
  app.add_option("--extent-mm", settings.extent_mm, "longest side of each mesh")->check(CLI::PositiveNumber);
  app.add_option("--smallest-spacing", settings.smallest_spacing, "of the subdivision, in smooth distances");
  app.add_option("--largest-spacing", settings.largest_spacing, "of the subdivision, in smooth distances");
  app.add_option("--cache", settings.cache, "folder that keeps the reference of each cell from run to run");
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
    return 1;
  }
}

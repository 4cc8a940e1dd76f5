// How well harmonics stand for an environment, and how even a sphere is in even light.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "CLI/CLI.hpp"
#include "diffusion/dipole_integral.h"
#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tests/support/cells.h"
#include "tests/support/error_parts.h"

namespace diaphane {
namespace {

using nlohmann::json;

constexpr float kIndices[] = {1, 1.3f, 1.5f};

json map_row(const std::string& name) {
  optics::LatLongMap map = testing::environment_map(name);
  const std::vector<glm::vec3> normals = optics::spread_directions(200);
  const double before = optics::harmonics_error(map, normals, 1.5f);
  const size_t lamps = optics::take_out_lamps(map).size();
  json row = {
      {"map", name}, {"width_px", map.width_px}, {"height_px", map.height_px}, {"lamps", lamps}, {"before", before}};
  std::printf("%-12s %4ux%-4u %9.2f %6zu ", name.c_str(), map.width_px, map.height_px, 100 * before, lamps);
  for (const float index : kIndices) {
    const double error = optics::harmonics_error(map, normals, index);
    row["after"].push_back(error);
    std::printf(" %6.2f", 100 * error);
  }
  std::printf("\n");
  return row;
}

/// A sphere by latitude and longitude has poles; this one is a cube's grid pushed out.
testing::Mesh make_sphere(float radius_mm, float spacing_mm) {
  testing::Mesh sphere = testing::make_box(glm::vec3(2 * radius_mm), spacing_mm);
  for (glm::vec3& p : sphere.positions_mm) {
    const glm::vec3 q = p / radius_mm, qq = q * q;
    p = radius_mm * q *
        glm::sqrt(glm::max(glm::vec3(0), glm::vec3(1) -
                                             0.5f * (glm::vec3(qq.y, qq.z, qq.x) + glm::vec3(qq.z, qq.x, qq.y)) +
                                             glm::vec3(qq.y * qq.z, qq.z * qq.x, qq.x * qq.y) / 3.0f));
  }
  sphere.normals = sphere.positions_mm;
  for (glm::vec3& n : sphere.normals) n = glm::normalize(n);
  return sphere;
}

json sphere_row(const std::string& material) {
  const auto preset = optics::find_preset(material);
  const testing::Mesh sphere =
      testing::as_served(make_sphere(10, 0.25f), preset->coefficients, diffusion::Quality::kFine);
  testing::Cell cell{"sphere", material, "even", sphere, preset->coefficients, {}, {}};
  cell.irradiance = [](const glm::vec3&, const glm::vec3&) { return glm::vec3(1); };
  diffusion::DipoleIntegral integral(
      diffusion::build_surface_topology(*geometry::build_topology(sphere.positions_mm, sphere.triangles)));
  const std::vector<glm::vec3> radiosity = testing::integral_radiosity(
      integral, sphere, cell, diffusion::openings_of(diffusion::Quality::kFine, cell.material));
  double deviation = 0, range = 0;
  for (int c = 0; c < 3; ++c) {
    double sum = 0, squares = 0, least = 1e30, most = 0;
    for (const glm::vec3& b : radiosity) {
      sum += b[c];
      squares += double{b[c]} * b[c];
      least = std::min<double>(least, b[c]);
      most = std::max<double>(most, b[c]);
    }
    const double mean = sum / static_cast<double>(radiosity.size());
    deviation = std::max(
        deviation, std::sqrt(std::max(0.0, squares / static_cast<double>(radiosity.size()) - mean * mean)) / mean);
    range = std::max(range, (most - least) / mean);
  }
  std::printf("%-12s %9zu %12.3f %12.3f\n", material.c_str(), sphere.triangles.size(), 100 * deviation, 100 * range);
  return {{"material", material}, {"triangles", sphere.triangles.size()}, {"deviation", deviation}, {"range", range}};
}

int run(const std::string& json_path) {
  json result;
  std::printf(
      "E(N) of 25 harmonics against the sum over all pixels, Fresnel inside, at 200 directions: RMS difference over "
      "mean, worst\n"
      "channel, %%: of the map at an index of 1.5, and once lamps are taken out at 1, 1.3 and 1.5.\n");
  std::printf("%-12s %9s %9s %6s  %6s %6s %6s\n", "map", "size", "before", "lamps", "1", "1.3", "1.5");
  for (const std::string& name : testing::environment_names()) result["maps"].push_back(map_row(name));
  std::printf(
      "\nB over a sphere of 10 mm in even light, by the integral (fine), worst channel, %% of the mean: standard "
      "deviation, and\n"
      "largest less smallest.\n");
  std::printf("%-12s %9s %12s %12s\n", "material", "triangles", "deviation", "range");
  for (const char* material : {"marble", "skin1", "wholemilk", "ketchup"})
    result["sphere"].push_back(sphere_row(material));
  if (!json_path.empty()) std::ofstream(json_path) << result.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  CLI::App app("Environments: what harmonics leave out, and how even a sphere is in even light");
  std::string json_path;
  app.add_option("--json", json_path, "file for the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(json_path);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_environment: %s\n", error.what());
    return 1;
  }
}

// Times of the surface integral's stages: five meshes, one and two threads, medians over frames of a deforming body.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diffusion/dipole_integral.h"
#include "diffusion/simd_level.h"
#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tbb/parallel_for.h"
#include "tbb/task_arena.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"

namespace diaphane {
namespace {

struct Settings {
  std::vector<std::string> files = {"hand_7k7.ply", "demon_standin_goathead_48k.ply", "bunny_closed_72k.ply",
                                    "neptune_227k.ply", "buddha_381k.ply"};
  std::vector<int> threads = {1, 2};
  std::vector<std::string> simd = {""};
  std::string material = "marble";
  std::string quality = "fine";
  int frames = 30;
  bool coloured = false;
  std::string json;
};

constexpr const char* kStages[] = {"normals", "E + flux", "refit", "gather", "all"};

using Times = std::map<std::string, std::vector<double>>;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// The body of a point light's arithmetic, without a call for each point: what a renderer's own loop costs.
glm::vec3 irradiance_at(const std::vector<testing::PointLight>& lights, float eta, const glm::vec3& p,
                        const glm::vec3& n) {
  glm::vec3 sum(0);
  for (const testing::PointLight& light : lights) {
    const glm::vec3 way = light.position_mm - p;
    const float distance2 = glm::dot(way, way), cosine = glm::dot(n, way) / std::sqrt(distance2);
    if (cosine > 0) sum += light.intensity_w_sr * (optics::fresnel_transmittance(eta, cosine) * cosine / distance2);
  }
  return sum;
}

Times measure(const testing::Mesh& mesh, const Settings& settings, int threads) {
  const auto topology = diffusion::build_surface_topology(*geometry::build_topology(mesh.positions_mm, mesh.triangles));
  diffusion::DipoleIntegral integral(topology, threads);
  const optics::Coefficients material = optics::find_preset(settings.material).value().coefficients;
  integral.set_material(material);
  std::vector<testing::PointLight> lights = {{{25, 30, 40}, glm::vec3(12000)}};
  if (settings.coloured) lights = {{{30, 20, 30}, {12000, 3000, 500}}, {{-30, 10, -20}, {300, 2000, 12000}}};
  const diffusion::Quality quality = settings.quality == "draft"    ? diffusion::Quality::kDraft
                                     : settings.quality == "normal" ? diffusion::Quality::kNormal
                                                                    : diffusion::Quality::kFine;
  const size_t vertices = mesh.positions_mm.size();
  std::vector<glm::vec3> positions = mesh.positions_mm, normals(vertices), radiosity(vertices), at_vertices(vertices);
  std::vector<glm::vec3> at_triangles(mesh.triangles.size());
  tbb::task_arena arena(threads);
  Times times;
  for (int frame = -3; frame < settings.frames; ++frame) {
    const float bend = 0.02f * std::sin(0.3f * static_cast<float>(frame));
    for (size_t v = 0; v < vertices; ++v) {
      positions[v] = mesh.positions_mm[v];
      positions[v].x += bend * positions[v].y;
    }
    auto last = std::chrono::steady_clock::now();
    double all = 0;
    const auto lap = [&](const char* stage) {
      const auto now = std::chrono::steady_clock::now();
      const double ms = std::chrono::duration<double, std::milli>(now - last).count();
      last = now;
      all += ms;
      if (frame >= 0) times[stage].push_back(ms);
    };
    integral.update_positions(positions, normals);
    lap("normals");
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.triangles.size(), 1024), [&](const auto& range) {
        for (size_t t = range.begin(); t < range.end(); ++t) {
          const glm::uvec3& i = topology->triangles[t];
          const glm::vec3 sum = normals[i.x] + normals[i.y] + normals[i.z];
          at_triangles[t] = irradiance_at(lights, material.refractive_index,
                                          (positions[i.x] + positions[i.y] + positions[i.z]) / 3.0f,
                                          sum / std::max(glm::length(sum), 1e-20f));
        }
      });
      tbb::parallel_for(tbb::blocked_range<size_t>(0, vertices, 1024), [&](const auto& range) {
        for (size_t v = range.begin(); v < range.end(); ++v) {
          at_vertices[v] = irradiance_at(lights, material.refractive_index, positions[v], normals[v]);
        }
      });
    });
    integral.set_irradiance(at_triangles, at_vertices);
    lap("E + flux");
    integral.refit_geometry();
    integral.refit_flux();
    lap("refit");
    integral.gather(quality, radiosity);
    lap("gather");
    if (frame >= 0) times["all"].push_back(all);
  }
  times["bytes a vertex"].push_back(static_cast<double>(integral.bytes()) / static_cast<double>(vertices));
  return times;
}

int run(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  std::printf("%-32s %8s %-6s %7s |", "mesh", "vertices", "simd", "threads");
  for (const char* stage : kStages) std::printf(" %9s", stage);
  std::printf("  ms, medians of %d frames; %s, %s\n", settings.frames, settings.material.c_str(),
              settings.quality.c_str());
  for (const std::string& file : settings.files) {
    auto mesh = testing::read_mesh(testing::shared_path("data/meshes/" + file));
    if (!mesh) {
      std::fprintf(stderr, "bench_integral: %s is not there\n", file.c_str());
      continue;
    }
    testing::scale_to(*mesh, 20);
    for (const std::string& level : settings.simd) {
      if (!diffusion::choose_simd_level(level)) {
        std::fprintf(stderr, "bench_integral: this machine has no %s\n", level.c_str());
        continue;
      }
      for (const int threads : settings.threads) {
        Times times = measure(*mesh, settings, threads);
        nlohmann::json row = {{"mesh", file},
                              {"triangles", mesh->triangles.size()},
                              {"vertices", mesh->positions_mm.size()},
                              {"simd_level", diffusion::simd_level()},
                              {"threads", threads},
                              {"bytes_a_vertex", times["bytes a vertex"].front()}};
        std::printf("%-32s %8zu %-6s %7d |", file.c_str(), mesh->positions_mm.size(), diffusion::simd_level().c_str(),
                    threads);
        for (const char* stage : kStages) {
          const double ms = median(times[stage]);
          row["milliseconds"][stage] = ms;
          std::printf(" %9.3f", ms);
        }
        std::printf("  %.0f bytes a vertex\n", times["bytes a vertex"].front());
        std::fflush(stdout);
        rows.push_back(row);
      }
    }
  }
  if (!settings.json.empty()) {
    std::ofstream(settings.json)
        << nlohmann::json{{"material", settings.material}, {"quality", settings.quality}, {"rows", rows}}.dump(1)
        << "\n";
  }
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Times of the surface integral's stages, ms");
  app.add_option("--meshes", settings.files, "files of data/meshes")->delimiter(',');
  app.add_option("--threads", settings.threads)->delimiter(',');
  app.add_option("--simd", settings.simd, "levels to compare, such as AVX2,SSE4; default the best")->delimiter(',');
  app.add_option("--material", settings.material, "preset");
  app.add_option("--quality", settings.quality)->check(CLI::IsMember({"draft", "normal", "fine"}));
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 10000));
  app.add_flag("--coloured", settings.coloured, "two lights of different colours");
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  return diaphane::run(settings);
}

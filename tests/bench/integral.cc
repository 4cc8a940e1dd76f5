// What a translucent frame costs, stage by stage, beside a plain opaque one of the same mesh: five meshes, one and two
// threads, shadows off and on; medians over frames, all in one run.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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
#include "fmt/format.h"
#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "render/gl_renderer.h"
#include "render/projection.h"
#include "tbb/global_control.h"
#include "tests/bench/lambert_frame.h"
#include "tests/support/meshes.h"

namespace diaphane {
namespace {

struct Settings {
  std::vector<std::string> files = {"hand_7k7.ply", "demon_standin_goathead_48k.ply", "bunny_closed_72k.ply",
                                    "neptune_227k.ply", "buddha_381k.ply"};
  std::vector<int> threads = {1, 2};  ///< several: a process for each
  std::vector<std::string> simd = {""};
  std::vector<std::string> shadows = {"off", "on"};
  std::string material = "marble";
  std::string quality = "fine";
  int frames = 21;
  uint32_t size_px = 512;
  bool coloured = false;
  std::string json;
};

/// Columns of the table, and which of a frame's stages each adds up.
const std::vector<std::pair<std::string, std::vector<std::string>>> kColumns = {
    {"normals", {"place", "refine", "normals"}},
    {"E + flux", {"shadow", "irradiance", "flux"}},
    {"refit", {"refit"}},
    {"gather", {"gather"}},
    {"draw", {"upload", "draw", "read_back"}}};

constexpr glm::vec3 kLight{25, 30, 40};

using Times = std::map<std::string, std::vector<double>>;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

template <class Work>
double milliseconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

diffusion::Quality quality_of(const std::string& name) {
  if (name == "draft") return diffusion::Quality::kDraft;
  return name == "normal" ? diffusion::Quality::kNormal : diffusion::Quality::kFine;
}

std::shared_ptr<scene::SceneSnapshot> make_scene(const testing::Mesh& mesh, const Settings& settings) {
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->name = "scenes/bench";
  scene->materials.push_back({"material", settings.material, optics::find_preset(settings.material)->coefficients});
  auto body = std::make_shared<scene::Mesh>();
  body->name = "mesh";
  body->material = "material";
  body->topology = *geometry::build_topology(mesh.positions_mm, mesh.triangles);
  scene->meshes.push_back(body);
  if (settings.coloured) {
    scene->lights.push_back({"a", scene::PointLight{{30, 20, 30}, {12000, 3000, 500}}});
    scene->lights.push_back({"b", scene::PointLight{{-30, 10, -20}, {300, 2000, 12000}}});
  } else {
    scene->lights.push_back({"a", scene::PointLight{kLight, glm::vec3(12000)}});
  }
  return scene;
}

/// The mesh leaning to and fro.
std::vector<glm::vec3> bend(const testing::Mesh& mesh, int frame) {
  std::vector<glm::vec3> positions = mesh.positions_mm;
  const float share = 0.02f * std::sin(0.3f * static_cast<float>(frame));
  for (glm::vec3& p : positions) p.x += share * p.y;
  return positions;
}

scene::Camera orbit(int frame) {
  const float angle = 0.05f * static_cast<float>(frame);
  return {{45 * std::sin(angle), 0, 45 * std::cos(angle)}, {0, 0, 0}, {0, 1, 0}, 30};
}

/// One frame; books its stages where `times` is given.
void render(render::FrameRenderer& renderer, const render::FrameRequest& request, const std::string& kind,
            Times* times) {
  absl::StatusOr<render::Frame> frame;
  const double whole = milliseconds([&] { frame = renderer.render(request, std::atomic<bool>(false)); });
  if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
  if (times == nullptr) return;
  (*times)[kind].push_back(whole);
  if (kind != "deforming") return;
  double update = 0;
  for (const auto& [column, stages] : kColumns) {
    double sum = 0;
    for (const render::StageTime& time : frame->stages) {
      if (std::find(stages.begin(), stages.end(), time.stage) != stages.end()) sum += time.milliseconds;
    }
    (*times)[column].push_back(sum);
    if (column != "draw") update += sum;
  }
  (*times)["update"].push_back(update);
}

Times measure(const testing::Mesh& mesh, const Settings& settings, bool shadows, render::FrameRenderer& renderer) {
  const auto scene = make_scene(mesh, settings);
  bench::LambertFrame lambert(mesh.triangles, settings.size_px);
  render::FrameRequest request;
  request.width_px = request.height_px = settings.size_px;
  request.settings.quality = quality_of(settings.quality);
  request.settings.shadows = shadows;
  Times times;
  for (int i = -3; i < settings.frames; ++i) {
    Times* booked = i < 0 ? nullptr : &times;
    auto deformed = std::make_shared<scene::SceneSnapshot>(*scene);
    auto body = std::make_shared<scene::Mesh>(*scene->meshes.front());
    const std::vector<glm::vec3> positions = bend(mesh, i);
    body->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{positions, {}});
    deformed->meshes.front() = body;
    request.scene = deformed;
    request.camera = orbit(0);
    render(renderer, request, "deforming", booked);
    request.camera = orbit(i);
    render(renderer, request, "camera", booked);

    const glm::mat4 clip = render::clip_from_world(request.camera, 1, 1, geometry::bounds_of(positions));
    const double upload = milliseconds([&] { lambert.upload(positions, mesh.normals); });
    const double first = milliseconds([&] { lambert.draw(clip, kLight); });
    const double again = milliseconds([&] { lambert.draw(clip, kLight); });
    if (booked == nullptr) continue;
    times["lambert"].push_back(upload + first);
    times["lambert camera"].push_back(again);
  }
  return times;
}

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  for (const auto& column : kColumns) names.push_back(column.first);
  for (const char* sum : {"update", "deforming", "camera", "lambert", "lambert camera"}) names.emplace_back(sum);
  return names;
}

nlohmann::json measure_row(const testing::Mesh& mesh, const std::string& file, const Settings& settings,
                           const std::string& shadows, render::FrameRenderer& renderer) {
  const Times times = measure(mesh, settings, shadows == "on", renderer);
  nlohmann::json row = {{"mesh", file},
                        {"triangles", mesh.triangles.size()},
                        {"shadows", shadows},
                        {"simd_level", diffusion::simd_level()},
                        {"threads", settings.threads.front()}};
  std::printf("%-14.14s %7zu %-5s %-3s %2d |", file.c_str(), mesh.triangles.size(), diffusion::simd_level().c_str(),
              shadows.c_str(), settings.threads.front());
  for (const std::string& name : column_names()) {
    const double ms = median(times.at(name));
    row["milliseconds"][name] = ms;
    std::printf(" %8.2f", ms);
  }
  const auto ratio = [&](const char* of, const char* to) {
    const double value = median(times.at(of)) / median(times.at(to));
    row["ratio"][of] = value;
    std::printf(" %5.2f", value);
  };
  std::printf(" |");
  ratio("update", "lambert");
  ratio("deforming", "lambert");
  ratio("camera", "lambert camera");
  std::printf("\n");
  std::fflush(stdout);
  return row;
}

/// Every row of one thread count, in this process.
nlohmann::json measure_rows(const Settings& settings) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<size_t>(settings.threads.front()));
  auto renderer = render::make_gl_renderer({});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  nlohmann::json rows = nlohmann::json::array();
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
      for (const std::string& shadows : settings.shadows) {
        rows.push_back(measure_row(*mesh, file, settings, shadows, **renderer));
      }
    }
  }
  return rows;
}

/// The software renderer reads its thread count once, as its first context is made: each count has a process.
int run_process_of(int threads, std::vector<std::string> arguments, const std::string& json) {
  arguments.insert(arguments.end(), {"--threads", std::to_string(threads), "--json", json});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  pid_t child = 0;
  if (posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, argv.data(), environ) != 0) return 1;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

int run_all(const Settings& settings, const std::vector<std::string>& arguments) {
  std::printf("%-14s %7s %-5s %-3s %2s |", "mesh", "tris", "simd", "sh", "th");
  for (const std::string& name : column_names()) std::printf(" %8.8s", name.c_str());
  std::printf(" | update, deforming, camera-only over Lambert; ms, medians of %d frames, %s, %s, %u²\n",
              settings.frames, settings.material.c_str(), settings.quality.c_str(), settings.size_px);
  std::fflush(stdout);
  nlohmann::json rows = nlohmann::json::array();
  for (const int threads : settings.threads) {
    const std::string part =
        fmt::format("{}.{}", settings.json.empty() ? "/tmp/bench_integral" : settings.json, threads);
    if (const int failed = run_process_of(threads, arguments, part); failed != 0) return failed;
    for (const auto& row : nlohmann::json::parse(std::ifstream(part))["rows"]) rows.push_back(row);
    unlink(part.c_str());
  }
  if (settings.json.empty()) return 0;
  const nlohmann::json table = {{"material", settings.material}, {"quality", settings.quality}, {"rows", rows}};
  std::ofstream(settings.json) << table.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Times of a translucent frame's stages beside a plain opaque frame, ms");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  const auto list = [&](const char* name, auto& values, const char* help) {
    return app.add_option(name, values, help)->delimiter(',')->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  list("--meshes", settings.files, "files of data/meshes");
  auto* threads = list("--threads", settings.threads, "this many, in this process alone; default: one and two");
  list("--simd", settings.simd, "levels to compare, such as AVX2,SSE4; default the best");
  list("--shadows", settings.shadows, "off,on")->check(CLI::IsMember({"on", "off"}));
  app.add_option("--material", settings.material, "preset");
  app.add_option("--quality", settings.quality)->check(CLI::IsMember({"draft", "normal", "fine"}));
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 10000));
  app.add_option("--size", settings.size_px, "pixels a side")->check(CLI::Range(16, 4096));
  app.add_flag("--coloured", settings.coloured, "two lights of different colours");
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    if (threads->count() == 0) return diaphane::run_all(settings, std::vector<std::string>(argv, argv + argc));
    const nlohmann::json rows = diaphane::measure_rows(settings);
    if (!settings.json.empty()) std::ofstream(settings.json) << nlohmann::json{{"rows", rows}}.dump(1) << "\n";
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_integral: %s\n", error.what());
    return 1;
  }
  return 0;
}

// What a translucent frame costs, stage by stage, beside a plain opaque one of the same mesh: five meshes, one and two
// threads, shadows off and on; medians over frames, all in one run.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
#include "render/gl_renderer.h"
#include "render/projection.h"
#include "tbb/global_control.h"
#include "tests/bench/lambert_frame.h"
#include "tests/bench/timed_scenes.h"
#include "tests/support/meshes.h"

namespace diaphane {
namespace {

struct Settings {
  std::vector<std::string> files = bench::five_meshes();
  std::vector<int> threads = {1, 2};  ///< several: a process for each
  std::vector<std::string> simd = {""};
  std::vector<std::string> shadows = {"off", "on"};
  std::vector<std::string> extras = {"-"};
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
    {"gather", {"gather", "slab"}},
    {"draw", {"upload", "draw", "read_back", "gbuffer", "coat", "develop"}}};

using Times = std::map<std::string, std::vector<double>>;

/// One frame; books its stages where `times` is given.
void render(render::FrameRenderer& renderer, const render::FrameRequest& request, const std::string& kind,
            Times* times) {
  absl::StatusOr<render::Frame> frame;
  const double whole = bench::milliseconds([&] { frame = renderer.render(request, std::atomic<bool>(false)); });
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

/// What a row has beside the plain frame: nothing (-), the slab correction, a profile, an environment, a coat in the
/// light or in an environment, an albedo, that and a coat with normal and roughness maps, or an
/// environment that bodies hide.
const std::vector<std::string> kExtras = {
    "-",      "slab",      "better-dipole",       "normalized-diffusion", "environment", "coat", "coat+environment",
    "albedo", "coat+maps", "occluded environment"};

/// A sky without lamps, so that the row tells the harmonics and the map alone.
std::shared_ptr<const scene::Environment> sky(bool occluded) {
  optics::LatLongMap map{512, 256, {}};
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) map.radiance.push_back(0.5f + 0.2f * map.direction(x, y));
  }
  auto light = std::make_shared<const optics::EnvironmentLight>(optics::EnvironmentLight{optics::project(map), {}});
  return std::make_shared<const scene::Environment>(scene::Environment{
      "environment", std::make_shared<const optics::LatLongMap>(std::move(map)), std::move(light), 0, 1, occluded});
}

/// 1024² of no particular pattern, thrown on the mesh from its front.
void add_pictures(const testing::Mesh& mesh, bool maps, scene::SceneSnapshot& scene) {
  scene::TexturePixels pixels{1024, 1024, {}};
  pixels.rgba.resize(4 * 1024 * 1024);
  for (size_t i = 0; i < pixels.rgba.size(); ++i) pixels.rgba[i] = static_cast<uint8_t>(128 + i * 2654435761u % 127);
  const auto shared = std::make_shared<const scene::TexturePixels>(std::move(pixels));
  scene.textures = {{"albedo", shared, {.srgb = true}}, {"map", shared, {}}};
  scene.materials.front().textures = {.albedo = "albedo"};
  if (maps) scene.materials.front().textures = {.albedo = "albedo", .normal = "map", .roughness = "map"};
  geometry::SurfaceAttributes attributes;
  for (const glm::vec3& p : mesh.positions_mm) attributes.texture_coordinates.emplace_back(0.1f * p.x, -0.1f * p.y);
  auto textured = std::make_shared<scene::Mesh>(*scene.meshes.front());
  textured->attributes = std::make_shared<const geometry::SurfaceAttributes>(std::move(attributes));
  scene.meshes.front() = std::move(textured);
}

Times measure(const testing::Mesh& mesh, const Settings& settings, bool shadows, const std::string& extra,
              render::FrameRenderer& renderer) {
  const bool profile = extra == "better-dipole" || extra == "normalized-diffusion";
  const auto scene = bench::make_scene(mesh, profile ? settings.material + "+" + extra : settings.material,
                                       bench::lights(settings.coloured));
  if (extra.ends_with("environment")) scene->environment = sky(extra.starts_with("occluded"));
  if (extra.starts_with("coat")) scene->materials.front().coat = optics::Coat{0.1f};
  if (extra == "albedo" || extra == "coat+maps, occluded environment") add_pictures(mesh, extra == "coat+maps", *scene);
  bench::LambertFrame lambert(mesh.triangles, settings.size_px);
  render::FrameRequest request;
  request.width_px = request.height_px = settings.size_px;
  request.settings.quality = bench::quality_of(settings.quality);
  request.settings.shadows = shadows;
  request.settings.slab_correction = extra == "slab";
  Times times;
  for (int i = -3; i < settings.frames; ++i) {
    Times* booked = i < 0 ? nullptr : &times;
    const std::vector<glm::vec3> positions = bench::leaning(mesh, i);
    request.scene = bench::posed(*scene, positions);
    request.camera = bench::orbit(0);
    render(renderer, request, "deforming", booked);
    request.camera = bench::orbit(i);
    render(renderer, request, "camera", booked);

    const glm::mat4 clip = render::clip_from_world(request.camera, 1, 1, geometry::bounds_of(positions));
    const double upload = bench::milliseconds([&] { lambert.upload(positions, mesh.normals); });
    const double first = bench::milliseconds([&] { lambert.draw(clip, bench::kLight); });
    const double again = bench::milliseconds([&] { lambert.draw(clip, bench::kLight); });
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
                           const std::string& shadows, const std::string& extra, render::FrameRenderer& renderer) {
  const Times times = measure(mesh, settings, shadows == "on", extra, renderer);
  nlohmann::json row = {
      {"mesh", file},   {"triangles", mesh.triangles.size()},    {"shadows", shadows},
      {"extra", extra}, {"simd_level", diffusion::simd_level()}, {"threads", settings.threads.front()}};
  std::printf("%-14.14s %7zu %-5s %-3s %-6.6s %2d |", file.c_str(), mesh.triangles.size(),
              diffusion::simd_level().c_str(), shadows.c_str(), extra.c_str(), settings.threads.front());
  for (const std::string& name : column_names()) {
    const double ms = bench::median(times.at(name));
    row["milliseconds"][name] = ms;
    std::printf(" %8.2f", ms);
  }
  const auto ratio = [&](const char* of, const char* to) {
    const double value = bench::median(times.at(of)) / bench::median(times.at(to));
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
        for (const std::string& extra : settings.extras) {
          rows.push_back(measure_row(*mesh, file, settings, shadows, extra, **renderer));
        }
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
  std::printf("%-14s %7s %-5s %-3s %-6s %2s |", "mesh", "tris", "simd", "sh", "extra", "th");
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
  list("--extras", settings.extras,
       "rows: - (the plain frame), slab, a profile, environment, coat, coat+environment, albedo, "
       "coat+maps")
      ->check(CLI::IsMember(diaphane::kExtras));
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

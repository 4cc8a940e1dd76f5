// What each stage of a frame costs: five sizes, three techniques, the body deforming and still; medians over frames.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diffusion/simd_level.h"
#include "render/gl_renderer.h"
#include "tests/bench/timed_scenes.h"

namespace diaphane {
namespace {

using render::Technique;

struct Settings {
  std::string material = "marble";
  std::string quality = "normal";
  std::vector<std::string> techniques = {"integral", "paper", "lambert"};
  std::vector<std::string> meshes = {"hand", "demon", "bunny", "neptune", "buddha"};
  std::string raster = "auto";
  bool shadows = false;
  int frames = 15;
  uint32_t size_px = 512;
  std::string json;
};

const std::map<std::string, Technique> kTechniques = {
    {"integral", Technique::kIntegral}, {"paper", Technique::kPaper}, {"lambert", Technique::kLambert}};
const std::map<std::string, render::Raster> kRasters = {
    {"auto", render::Raster::kAuto}, {"gl", render::Raster::kGl}, {"native", render::Raster::kNative}};

/// Times by stage, in the order in which the frames name them.
class StageTable {
 public:
  void add(const render::Frame& frame) {
    for (const render::StageTime& stage : frame.stages) {
      if (!times_.contains(stage.stage)) order_.push_back(stage.stage);
      times_[stage.stage].push_back(stage.milliseconds);
    }
  }
  nlohmann::ordered_json medians() const {
    nlohmann::ordered_json all;
    for (const std::string& stage : order_) {
      const double ms = bench::median(times_.at(stage));
      if (ms > 0) all[stage] = ms;
    }
    return all;
  }

 private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> times_;
};

void measure(const testing::Mesh& mesh, const std::string& name, const std::string& technique, const Settings& settings,
             render::FrameRenderer& renderer, nlohmann::json& rows) {
  const auto scene = bench::make_scene(mesh, settings.material, bench::lights(false));
  render::FrameRequest request;
  request.width_px = request.height_px = settings.size_px;
  request.settings.technique = kTechniques.at(technique);
  request.settings.quality = bench::quality_of(settings.quality);
  request.settings.shadows = settings.shadows;
  for (const bool deforming : {true, false}) {
    StageTable stages;
    std::vector<double> whole;
    std::string path;
    request.scene = bench::posed(*scene, bench::leaning(mesh, 0));
    for (int i = -2; i < settings.frames; ++i) {
      if (deforming) request.scene = bench::posed(*scene, bench::leaning(mesh, i));
      request.camera = bench::orbit(i);
      absl::StatusOr<render::Frame> frame;
      const double ms = bench::milliseconds([&] { frame = renderer.render(request, std::atomic<bool>(false)); });
      if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
      if (i < 0) continue;
      whole.push_back(ms);
      stages.add(*frame);
      path = frame->path;
    }
    const nlohmann::ordered_json medians = stages.medians();
    std::printf("%-8s %7zu %-8s %-9s %7.2f |", name.c_str(), mesh.triangles.size(), technique.c_str(),
                deforming ? "deforming" : "camera", bench::median(whole));
    for (const auto& [stage, ms] : medians.items()) std::printf(" %s %.2f", stage.c_str(), ms.get<double>());
    std::printf("\n");
    std::fflush(stdout);
    rows.push_back({{"mesh", name},
                    {"triangles", mesh.triangles.size()},
                    {"technique", technique},
                    {"deforming", deforming},
                    {"path", path},
                    {"frame_ms", bench::median(whole)},
                    {"stage_ms", medians}});
  }
}

int run(const Settings& settings) {
  auto renderer = render::make_gl_renderer({.raster = kRasters.at(settings.raster)});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  const render::RendererInfo info = (*renderer)->info();
  std::printf("ms, medians of %d, %s, %s, %u², shadows %s, %s, %s: the frame, then its stages\n", settings.frames,
              settings.material.c_str(), settings.quality.c_str(), settings.size_px, settings.shadows ? "on" : "off",
              info.gl_renderer.c_str(), diffusion::simd_level().c_str());
  nlohmann::json rows = nlohmann::json::array();
  const std::vector<std::string> names = {"hand", "demon", "bunny", "neptune", "buddha"};
  for (size_t i = 0; i < names.size(); ++i) {
    if (std::find(settings.meshes.begin(), settings.meshes.end(), names[i]) == settings.meshes.end()) continue;
    auto mesh = testing::read_mesh(testing::shared_path("data/meshes/" + bench::five_meshes()[i]));
    if (!mesh) {
      std::fprintf(stderr, "bench_stages: %s is not there\n", bench::five_meshes()[i].c_str());
      continue;
    }
    testing::scale_to(*mesh, 20);
    for (const std::string& technique : settings.techniques) {
      measure(*mesh, names[i], technique, settings, **renderer, rows);
    }
  }
  if (settings.json.empty()) return 0;
  const nlohmann::json table = {{"material", settings.material},
                                {"quality", settings.quality},
                                {"size_px", settings.size_px},
                                {"shadows", settings.shadows},
                                {"gl_renderer", info.gl_renderer},
                                {"simd_level", diffusion::simd_level()},
                                {"rows", rows}};
  std::ofstream(settings.json) << table.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("What each stage of a frame costs");
  app.add_option("--material", settings.material, "preset");
  app.add_option("--quality", settings.quality)->check(CLI::IsMember({"draft", "normal", "fine"}));
  app.add_option("--techniques", settings.techniques)
      ->delimiter(',')
      ->check(CLI::IsMember({"integral", "paper", "lambert"}));
  app.add_option("--meshes", settings.meshes)
      ->delimiter(',')
      ->check(CLI::IsMember({"hand", "demon", "bunny", "neptune", "buddha"}));
  app.add_option("--raster", settings.raster)->check(CLI::IsMember({"auto", "gl", "native"}));
  app.add_flag("--shadows", settings.shadows);
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 10000));
  app.add_option("--size", settings.size_px, "pixels a side")->check(CLI::Range(16, 4096));
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_stages: %s\n", error.what());
    return 1;
  }
}

// The paper's Table 2: frames per second at five sizes, with deformation and without, both techniques, next to the
// paper's figures and to a plain opaque frame of the same mesh; medians over frames, all in one run.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diffusion/simd_level.h"
#include "render/gl_renderer.h"
#include "render/projection.h"
#include "tests/bench/lambert_frame.h"
#include "tests/bench/timed_scenes.h"

namespace diaphane {
namespace {

using render::Technique;

struct Settings {
  std::string material = "marble";
  std::string quality = "normal";
  std::vector<std::string> shadows = {"off", "on"};
  int frames = 21;
  uint32_t size_px = 512;
  uint32_t face_size_px = 256;
  std::string json;
};

struct PaperRow {
  const char* name;
  double deforming, still;  ///< frames per second, on a GeForce 7900 GTX
};
constexpr PaperRow kPaper[] = {
    {"hand", 72, 120}, {"demon", 49, 81}, {"bunny", 43, 71}, {"neptune", 25, 41}, {"buddha", 22, 28}};

struct Times {
  std::vector<double> deforming, camera, awake, lambert;
};

void render(render::FrameRenderer& renderer, const render::FrameRequest& request, std::vector<double>* times) {
  absl::StatusOr<render::Frame> frame;
  const double whole = bench::milliseconds([&] { frame = renderer.render(request, std::atomic<bool>(false)); });
  if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
  if (times != nullptr) times->push_back(whole);
}

Times measure(const testing::Mesh& mesh, const Settings& settings, Technique technique, bool shadows,
              render::FrameRenderer& renderer) {
  const auto scene = bench::make_scene(mesh, settings.material, bench::lights(false));
  bench::LambertFrame lambert(mesh.triangles, settings.size_px);
  render::FrameRequest request;
  request.width_px = request.height_px = settings.size_px;
  request.settings.technique = technique;
  request.settings.quality = bench::quality_of(settings.quality);
  request.settings.shadows = shadows;
  request.settings.paper.face_size_px = settings.face_size_px;
  Times times;
  for (int i = -3; i < settings.frames; ++i) {
    const auto booked = [&](std::vector<double>& of) { return i < 0 ? nullptr : &of; };
    const std::vector<glm::vec3> positions = bench::leaning(mesh, i);
    request.camera = bench::orbit(0);
    request.scene = bench::posed(*scene, positions);
    render(renderer, request, booked(times.deforming));
    request.camera = bench::orbit(i);
    render(renderer, request, booked(times.camera));
    request.scene = bench::posed(*scene, positions);
    request.camera = bench::orbit(i + 1);
    render(renderer, request, booked(times.awake));
    const glm::mat4 clip = render::clip_from_world(request.camera, 1, 1, geometry::bounds_of(positions));
    const double opaque = bench::milliseconds([&] {
      lambert.upload(positions, mesh.normals);
      lambert.draw(clip, bench::kLight);
    });
    if (i >= 0) times.lambert.push_back(opaque);
  }
  return times;
}

nlohmann::json measure_row(const testing::Mesh& mesh, const PaperRow& paper, const Settings& settings,
                           Technique technique, bool shadows, render::FrameRenderer& renderer) {
  const Times times = measure(mesh, settings, technique, shadows, renderer);
  const auto fps = [](const std::vector<double>& ms) { return 1000 / bench::median(ms); };
  const char* name = technique == Technique::kPaper ? "paper" : "integral";
  std::printf("%-8s %7zu %-9s %-3s | %7.2f %7.2f %7.2f | %7.1f %7.1f %7.1f | %4.0f %4.0f | %7.1f\n", paper.name,
              mesh.triangles.size(), name, shadows ? "on" : "off", fps(times.deforming) / paper.deforming,
              fps(times.camera) / paper.still, fps(times.awake) / paper.still, fps(times.deforming), fps(times.camera),
              fps(times.awake), paper.deforming, paper.still, fps(times.lambert));
  std::fflush(stdout);
  return {{"mesh", paper.name},
          {"triangles", mesh.triangles.size()},
          {"technique", name},
          {"shadows", shadows},
          {"fps",
           {{"deforming", fps(times.deforming)},
            {"camera", fps(times.camera)},
            {"awake", fps(times.awake)},
            {"lambert", fps(times.lambert)}}},
          {"paper_fps", {{"deforming", paper.deforming}, {"still", paper.still}}}};
}

int run(const Settings& settings) {
  auto renderer = render::make_gl_renderer({});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  const render::RendererInfo info = (*renderer)->info();
  std::printf(
      "Frames per second, medians of %d, %s, %s, %u², faces of %u, %s, %s. `deforming`: new positions every frame; "
      "`camera`: it\n"
      "alone moves, what is unchanged sleeps; `awake`: the same with every stage run. First over the paper's figures, "
      "then\n"
      "themselves, then the paper's, with deformation and without, then a plain opaque frame of the deforming mesh.\n",
      settings.frames, settings.material.c_str(), settings.quality.c_str(), settings.size_px, settings.face_size_px,
      info.gl_renderer.c_str(), diffusion::simd_level().c_str());
  std::printf("%-8s %7s %-9s %-3s | %7s %7s %7s | %7s %7s %7s | %4s %4s | %7s\n", "mesh", "tris", "technique", "sh",
              "deform", "camera", "awake", "deform", "camera", "awake", "def.", "not", "lambert");
  nlohmann::json rows = nlohmann::json::array();
  for (size_t i = 0; i < std::size(kPaper); ++i) {
    const std::string& file = bench::five_meshes()[i];
    auto mesh = testing::read_mesh(testing::shared_path("data/meshes/" + file));
    if (!mesh) {
      std::fprintf(stderr, "bench_table2: %s is not there\n", file.c_str());
      continue;
    }
    testing::scale_to(*mesh, 20);
    for (const Technique technique : {Technique::kIntegral, Technique::kPaper}) {
      for (const std::string& shadows : settings.shadows) {
        if (technique == Technique::kPaper && shadows == "on") continue;  // published without
        rows.push_back(measure_row(*mesh, kPaper[i], settings, technique, shadows == "on", **renderer));
      }
    }
  }
  if (settings.json.empty()) return 0;
  const nlohmann::json table = {{"material", settings.material},
                                {"quality", settings.quality},
                                {"size_px", settings.size_px},
                                {"face_size_px", settings.face_size_px},
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
  CLI::App app("The paper's Table 2: frames per second with deformation and without");
  app.add_option("--material", settings.material, "preset");
  app.add_option("--quality", settings.quality)->check(CLI::IsMember({"draft", "normal", "fine"}));
  app.add_option("--shadows", settings.shadows, "of the integral: off,on")
      ->delimiter(',')
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 10000));
  app.add_option("--size", settings.size_px, "pixels a side")->check(CLI::Range(16, 4096));
  app.add_option("--face-size", settings.face_size_px, "of the paper's cube, texels")->check(CLI::Range(16, 2048));
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_table2: %s\n", error.what());
    return 1;
  }
}

// What each technique costs for the error that it makes: one body, one picture, the reference as the judge.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "CLI/CLI.hpp"
#include "diffusion/simd_level.h"
#include "glm/geometric.hpp"
#include "render/gl_renderer.h"
#include "tests/support/cells.h"
#include "tests/support/views.h"

namespace diaphane {
namespace {

using nlohmann::json;
using render::Technique;

struct Settings {
  std::string mesh = "bunny", material = "marble", light = "front";
  uint32_t size_px = 512;
  int frames = 9;
  std::string json_path;
};

constexpr float kExtentMm = 20;

struct Row {
  const char* name;
  Technique technique;
  diffusion::Quality quality;
};
constexpr Row kRows[] = {{"integral, fine", Technique::kIntegral, diffusion::Quality::kFine},
                         {"integral, normal", Technique::kIntegral, diffusion::Quality::kNormal},
                         {"integral, draft", Technique::kIntegral, diffusion::Quality::kDraft},
                         {"paper", Technique::kPaper, diffusion::Quality::kFine},
                         {"lambert", Technique::kLambert, diffusion::Quality::kFine}};

struct Timed {
  double milliseconds;
  std::vector<glm::vec3> picture;
};

Timed timed(render::FrameRenderer& renderer, const render::FrameRequest& request) {
  const auto begin = std::chrono::steady_clock::now();
  Timed result{0, testing::radiance_of(renderer, request)};
  result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Over the pixels that see the body and whose neighbours do.
glm::vec3 error_of(const std::vector<glm::vec3>& picture, const std::vector<glm::vec3>& reference,
                   const testing::Sights& sights) {
  std::vector<glm::vec3> values, truth;
  for (size_t i = 0; i < picture.size(); ++i) {
    if (!sights.is_inside(i)) continue;
    values.push_back(picture[i]);
    truth.push_back(reference[i]);
  }
  return testing::relative_rms(values, truth);
}

int run(const Settings& settings) {
  auto made = render::make_gl_renderer({.warm_all = true});
  if (!made.ok()) throw std::runtime_error(std::string(made.status().message()));
  render::FrameRenderer& renderer = **made;
  const testing::Cell cell = testing::make_cell(settings.mesh, settings.material, settings.light, kExtentMm);
  const float radius_mm = testing::radius_of(cell.mesh);
  const testing::View view = testing::view_from({1, 1, 3}, radius_mm, settings.size_px);
  testing::View moved = view;
  moved.camera.eye.x *= 1.01f;
  const auto scene = testing::make_scene(cell.mesh, cell.material, cell.lights);
  const testing::Sights sights = testing::trace(cell.mesh, testing::MeshRays(cell.mesh), view);
  const Timed reference = timed(renderer, testing::unshadowed_request(scene, view, Technique::kReference));
  std::printf(
      "%s in %s, light %s, %u² pixels, unshadowed, %s, %s.\n"
      "Error: RMS difference over mean against the reference's picture, by channel, pixels off silhouettes. Times of "
      "a\n"
      "whole frame in ms, medians of %d: in a new pose, and with only the camera moved; the first frame once. Last, "
      "how\n"
      "many times as fast as the reference a frame in a new pose is.\n",
      settings.mesh.c_str(), settings.material.c_str(), settings.light.c_str(), settings.size_px,
      renderer.info().gl_renderer.c_str(), diffusion::simd_level().c_str(), settings.frames);
  std::printf("%-18s | %7s %7s %7s | %9s %9s %9s | %9s\n", "technique", "R %", "G %", "B %", "first", "pose", "camera",
              "reference/pose");
  std::printf("%-18s | %7.2f %7.2f %7.2f | %9.0f %9.0f %9.0f | %9.0f\n", "reference", 0.0, 0.0, 0.0,
              reference.milliseconds, reference.milliseconds, reference.milliseconds, 1.0);
  json rows = json::array();
  for (const Row& row : kRows) {
    const auto request = [&](const std::shared_ptr<const scene::SceneSnapshot>& of, const testing::View& from) {
      return testing::unshadowed_request(of, from, row.technique, row.quality);
    };
    // A scene of its own, so that nothing of the row before is left over.
    const auto own = testing::make_scene(cell.mesh, cell.material, cell.lights);
    const Timed first = timed(renderer, request(own, view));
    std::vector<double> pose, camera;
    for (int i = 0; i < settings.frames; ++i) {
      const auto posed = testing::with_pose(*own, cell.mesh);
      pose.push_back(timed(renderer, request(posed, view)).milliseconds);
      camera.push_back(timed(renderer, request(posed, moved)).milliseconds);
    }
    const glm::vec3 error = error_of(first.picture, reference.picture, sights);
    const double ratio = reference.milliseconds / median(pose);
    std::printf("%-18s | %7.2f %7.2f %7.2f | %9.1f %9.1f %9.1f | %9.0f\n", row.name, 100 * error.x, 100 * error.y,
                100 * error.z, first.milliseconds, median(pose), median(camera), ratio);
    rows.push_back({{"technique", row.name},
                    {"relative_rms", {error.x, error.y, error.z}},
                    {"first_ms", first.milliseconds},
                    {"pose_ms", median(pose)},
                    {"camera_ms", median(camera)},
                    {"reference_over_pose", ratio}});
  }
  if (!settings.json_path.empty()) {
    std::ofstream(settings.json_path) << json{{"simd_level", diffusion::simd_level()},
                                              {"gl_renderer", renderer.info().gl_renderer},
                                              {"size_px", settings.size_px},
                                              {"reference_ms", reference.milliseconds},
                                              {"techniques", rows}}
                                             .dump(1)
                                      << "\n";
  }
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("What each technique costs for the error that it makes, next to the reference");
  app.add_option("--mesh", settings.mesh, "bunny hand goathead fertility torus cup plate cube");
  app.add_option("--material", settings.material, "a preset");
  app.add_option("--light", settings.light, "front back two");
  app.add_option("--size", settings.size_px, "pixels a side")->check(CLI::Range(16, 2048));
  app.add_option("--frames", settings.frames, "frames that a median is taken of")->check(CLI::Range(1, 1000));
  app.add_option("--json", settings.json_path, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_techniques: %s\n", error.what());
    return 1;
  }
}

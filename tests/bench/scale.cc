// How a frame's cost grows: with triangles, pixels, lights and scenes, one of them at a time; and the exponent of each,
// fitted.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diffusion/simd_level.h"
#include "fmt/format.h"
#include "render/gl_renderer.h"
#include "tests/bench/timed_scenes.h"

namespace diaphane {
namespace {

using render::Technique;

struct Settings {
  std::vector<std::string> techniques = {"integral", "paper"};
  bool brief = false;
  int frames = 7;
  std::string json;
};

/// A ball with waves on it, 20 mm wide, of about so many triangles.
testing::Mesh waves(size_t triangles) {
  testing::Mesh mesh;
  const auto rings = static_cast<uint32_t>(std::max(4.0, std::round(std::sqrt(static_cast<double>(triangles) / 4))));
  const uint32_t sectors = 2 * rings;
  const auto place = [](double down, double around) {
    const double radius = 9 + std::sin(7 * down) * std::sin(5 * around);
    return glm::vec3(radius * std::sin(down) * std::cos(around), radius * std::cos(down),
                     -radius * std::sin(down) * std::sin(around));
  };
  mesh.positions_mm.push_back(place(0, 0));
  for (uint32_t ring = 1; ring < rings; ++ring) {
    for (uint32_t sector = 0; sector < sectors; ++sector) {
      mesh.positions_mm.push_back(place(std::numbers::pi * ring / rings, 2 * std::numbers::pi * sector / sectors));
    }
  }
  mesh.positions_mm.push_back(place(std::numbers::pi, 0));
  const auto last = static_cast<uint32_t>(mesh.positions_mm.size() - 1);
  const auto at = [&](uint32_t ring, uint32_t sector) {
    return ring == 0 ? 0u : ring == rings ? last : 1 + (ring - 1) * sectors + sector % sectors;
  };
  for (uint32_t ring = 0; ring < rings; ++ring) {
    for (uint32_t sector = 0; sector < sectors; ++sector) {
      const uint32_t a = at(ring, sector), b = at(ring + 1, sector), c = at(ring + 1, sector + 1);
      const uint32_t d = at(ring, sector + 1);
      if (ring + 1 < rings) mesh.triangles.emplace_back(a, b, c);
      if (ring > 0) mesh.triangles.emplace_back(a, c, d);
    }
  }
  return mesh;
}

/// So many lamps around the body, together as bright as one.
std::vector<scene::Light> lamps(uint32_t count) {
  std::vector<scene::Light> lights;
  for (uint32_t i = 0; i < count; ++i) {
    const float angle = 2.4f * static_cast<float>(i);
    const glm::vec3 place(45 * std::cos(angle), 20 * std::sin(1.7f * angle), 45 * std::sin(angle));
    lights.push_back(
        {fmt::format("l{}", i), scene::PointLight{place, glm::vec3(12000.0f / static_cast<float>(count))}});
  }
  return lights;
}

struct Size {
  size_t triangles = 64'000;
  uint32_t size_px = 512;
  uint32_t lights = 1;
  uint32_t scenes = 1;
};

struct Cost {
  double deforming_ms = 0, camera_ms = 0;
};

/// Of a frame of every scene, one after the other, as a server with so many viewers has it.
Cost cost_of(render::FrameRenderer& renderer, const std::string& technique, const Size& size, int frames) {
  const testing::Mesh mesh = waves(size.triangles);
  std::vector<std::shared_ptr<scene::SceneSnapshot>> scenes;
  for (uint32_t i = 0; i < size.scenes; ++i) {
    scenes.push_back(bench::make_scene(mesh, "marble", lamps(size.lights)));
    auto body = std::make_shared<scene::Mesh>(*scenes.back()->meshes.front());
    body->name = fmt::format("mesh{}", i);
    scenes.back()->meshes.front() = body;
  }
  render::FrameRequest request;
  request.width_px = request.height_px = size.size_px;
  request.settings.technique = technique == "paper" ? Technique::kPaper : Technique::kIntegral;
  request.settings.shadows = false;
  std::vector<std::shared_ptr<const scene::SceneSnapshot>> shown(scenes.size());
  std::vector<double> deforming, camera;
  const auto draw = [&] {
    double ms = 0;
    for (const auto& scene : shown) {
      request.scene = scene;
      absl::StatusOr<render::Frame> frame;
      ms += bench::milliseconds([&] { frame = renderer.render(request, std::atomic<bool>(false)); });
      if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
      renderer.recycle(*std::move(frame));
    }
    return ms;
  };
  for (int i = -1; i < frames; ++i) {
    for (size_t s = 0; s < scenes.size(); ++s) shown[s] = bench::posed(*scenes[s], bench::leaning(mesh, i));
    request.camera = bench::orbit(i);
    const double moved = draw();
    request.camera = bench::orbit(i + 1);
    const double turned = draw();
    if (i < 0) continue;
    deforming.push_back(moved);
    camera.push_back(turned);
  }
  return {bench::median(deforming), bench::median(camera)};
}

struct Point {
  double size;
  Cost cost;
};

/// The slope of ln cost over ln size by least squares.
double exponent(const std::vector<Point>& points, double Cost::*of) {
  double x_mean = 0, y_mean = 0, above = 0, below = 0;
  for (const Point& p : points) {
    x_mean += std::log(p.size) / static_cast<double>(points.size());
    y_mean += std::log(p.cost.*of) / static_cast<double>(points.size());
  }
  for (const Point& p : points) {
    const double x = std::log(p.size) - x_mean;
    above += x * (std::log(p.cost.*of) - y_mean);
    below += x * x;
  }
  return above / below;
}

struct Axis {
  std::string name;
  std::vector<double> sizes;
  Size (*at)(double);
};

std::vector<Axis> axes(bool brief) {
  const auto triangles = [](double n) { return Size{.triangles = static_cast<size_t>(n)}; };
  const auto pixels = [](double n) { return Size{.size_px = static_cast<uint32_t>(std::lround(std::sqrt(n)))}; };
  const auto lights = [](double n) { return Size{.lights = static_cast<uint32_t>(n)}; };
  const auto scenes = [](double n) {
    return Size{.triangles = 16'000, .size_px = 256, .scenes = static_cast<uint32_t>(n)};
  };
  if (brief) {
    return {{"triangles", {1e3, 4e3}, triangles},
            {"pixels", {65536, 262144}, pixels},
            {"lights", {1, 4}, lights},
            {"scenes", {1, 2}, scenes}};
  }
  return {{"triangles", {1e3, 4e3, 16e3, 64e3, 256e3, 1e6, 4e6}, triangles},
          {"pixels", {65536, 262144, 1048576, 4194304}, pixels},
          {"lights", {1, 4, 16, 64}, lights},
          {"scenes", {1, 2, 4, 8, 16, 32}, scenes}};
}

int run(const Settings& settings) {
  auto renderer = render::make_gl_renderer({});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  const render::RendererInfo info = (*renderer)->info();
  std::printf(
      "ms, medians of %d, marble, normal, shadows off, %s, %s; else 64k triangles (scenes: 16k), 512² (256²), one\n"
      "light, one scene. `scenes`: a frame of each. The exponent: of all, and of the two largest.\n",
      settings.frames, info.gl_renderer.c_str(), diffusion::simd_level().c_str());
  nlohmann::json rows = nlohmann::json::array(), fits = nlohmann::json::array();
  for (const std::string& technique : settings.techniques) {
    for (const Axis& axis : axes(settings.brief)) {
      std::vector<Point> points;
      for (const double size : axis.sizes) {
        points.push_back({size, cost_of(**renderer, technique, axis.at(size), settings.frames)});
        const Cost& cost = points.back().cost;
        std::printf("%-8s %-9s %8.0f | deforming %9.2f  camera %9.2f\n", technique.c_str(), axis.name.c_str(), size,
                    cost.deforming_ms, cost.camera_ms);
        std::fflush(stdout);
        rows.push_back({{"technique", technique},
                        {"axis", axis.name},
                        {"size", size},
                        {"deforming_ms", cost.deforming_ms},
                        {"camera_ms", cost.camera_ms}});
      }
      const std::vector<Point> largest(points.end() - 2, points.end());
      std::printf("%-8s %-9s exponent | deforming %9.2f  camera %9.2f | largest two %5.2f %5.2f\n", technique.c_str(),
                  axis.name.c_str(), exponent(points, &Cost::deforming_ms), exponent(points, &Cost::camera_ms),
                  exponent(largest, &Cost::deforming_ms), exponent(largest, &Cost::camera_ms));
      fits.push_back({{"technique", technique},
                      {"axis", axis.name},
                      {"deforming", exponent(points, &Cost::deforming_ms)},
                      {"camera", exponent(points, &Cost::camera_ms)},
                      {"deforming_largest", exponent(largest, &Cost::deforming_ms)},
                      {"camera_largest", exponent(largest, &Cost::camera_ms)}});
    }
  }
  if (settings.json.empty()) return 0;
  const nlohmann::json table = {
      {"gl_renderer", info.gl_renderer}, {"simd_level", diffusion::simd_level()}, {"rows", rows}, {"exponents", fits}};
  std::ofstream(settings.json) << table.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("How a frame's cost grows with triangles, pixels, lights and scenes");
  app.add_option("--techniques", settings.techniques)->delimiter(',')->check(CLI::IsMember({"integral", "paper"}));
  app.add_flag("--brief", settings.brief, "two small sizes of each: whether it runs, not what it costs");
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 1000));
  app.add_option("--json", settings.json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_scale: %s\n", error.what());
    return 1;
  }
}

// The native raster against OpenGL's: the same pictures by two roads.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "glm/gtc/matrix_transform.hpp"
#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"

namespace diaphane::render {
namespace {

constexpr uint32_t kWidth_px = 160, kHeight_px = 120;

FrameRequest request_of(Technique technique, std::shared_ptr<const scene::SceneSnapshot> scene) {
  FrameRequest request;
  request.scene = std::move(scene);
  request.settings.technique = technique;
  request.settings.shadows = false;
  request.format = PixelFormat::kLinearFloat;
  request.camera.eye = {25, 18, 40};
  request.camera.fov_y_deg = 35;
  request.width_px = kWidth_px;
  request.height_px = kHeight_px;
  return request;
}

/// A ball with waves on it, lit by two points: smooth, and not convex.
std::shared_ptr<scene::SceneSnapshot> waves() {
  Triangles ball = make_box({1, 1, 1}, 40);
  for (glm::vec3& p : ball.positions) {
    p = glm::normalize(p);
    p *= 9.0f + std::sin(5 * p.x) * std::sin(4 * p.y + 1);
  }
  auto scene = make_scene(std::move(ball), "marble");
  add_point_light(*scene, {20, 30, 40}, 4000);
  add_point_light(*scene, {-30, 5, 10}, 1000);
  return scene;
}

/// A sheet that shows its inside too.
std::shared_ptr<scene::SceneSnapshot> sheet() {
  Triangles plane = make_plane(20, 24);
  for (glm::vec3& p : plane.positions) p.z = 3 * std::sin(0.4f * p.x);
  auto scene = make_scene(std::move(plane), "skin1");
  add_point_light(*scene, {10, 20, 40}, 4000);
  return scene;
}

std::shared_ptr<scene::SceneSnapshot> with_lights(std::vector<scene::Light> lights) {
  auto scene = waves();
  scene->lights = std::move(lights);
  return scene;
}

std::shared_ptr<scene::SceneSnapshot> two_bodies() {
  auto scene = waves();
  auto other = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  other->name += "/other";
  // It mirrors.
  other->scene_from_mesh = glm::scale(glm::translate(glm::mat4(1), {12, 4, 6}), {-0.5f, 0.5f, 0.6f});
  scene->meshes.push_back(other);
  return scene;
}

using Requests = std::map<std::string, FrameRequest>;

Requests requests() {
  Requests all;
  for (const Technique technique : {Technique::kPaper, Technique::kIntegral}) {
    const std::string name = technique == Technique::kPaper ? "paper" : "integral";
    all[name + ", waves"] = request_of(technique, waves());
    all[name + ", sheet"] = request_of(technique, sheet());
    all[name + ", sheet from behind"] = request_of(technique, sheet());
    all[name + ", sheet from behind"].camera.eye = {5, 8, -40};
    all[name + ", two bodies"] = request_of(technique, two_bodies());
    all[name + ", shadows"] = request_of(technique, two_bodies());
    all[name + ", shadows"].settings.shadows = true;
    all[name + ", samples"] = request_of(technique, waves());
    all[name + ", samples"].settings.samples = 4;
    all[name + ", through a wall"] = request_of(technique, sheet());
    // Part of the sheet lies beside and behind the eye.
    all[name + ", through a wall"].camera.eye = {1, 0.5f, 4};
    all[name + ", through a wall"].camera.target = {8, 3, 0};
    all[name + ", tiles"] = request_of(technique, waves());
    all[name + ", tiles"].width_px = 2100;
    all[name + ", tiles"].height_px = 64;
  }
  all["paper, parallel light"] = request_of(
      Technique::kPaper, with_lights({{"a", scene::DirectionalLight{glm::normalize(glm::vec3(1, 2, 3)), {3, 2, 1}}}}));
  const scene::SpotLight spot{{{20, 30, 40}, {4000, 3000, 2000}}, {-20, -30, -40}, 5, 15};
  all["paper, spot"] = request_of(Technique::kPaper, with_lights({{"a", spot}}));
  for (const Terms terms : {Terms::kLocal, Terms::kGlobal}) {
    FrameRequest& request = all[terms == Terms::kLocal ? "paper, local" : "paper, global"];
    request = request_of(Technique::kPaper, waves());
    request.settings.paper.terms = terms;
    request.settings.paper.kernel_taps = terms == Terms::kLocal ? 6 : 3;
  }
  return all;
}

using Pixels = std::vector<glm::vec4>;

std::map<std::string, Pixels> draw(Raster raster) {
  auto renderer = make_gl_renderer({.raster = raster, .warm_all = false});
  EXPECT_TRUE(renderer.ok()) << renderer.status();
  std::map<std::string, Pixels> drawn;
  if (!renderer.ok()) return drawn;
  for (const auto& [name, request] : requests()) {
    const auto frame = (*renderer)->render(request, std::atomic<bool>(false));
    EXPECT_TRUE(frame.ok()) << name << ": " << frame.status();
    if (!frame.ok()) continue;
    EXPECT_EQ(
        frame->path.find("native raster") != std::string::npos || frame->path.find("native cube") != std::string::npos,
        raster == Raster::kNative)
        << frame->path;
    const auto& values = std::get<base::ImageF>(frame->image).values;
    Pixels& pixels = drawn[name];
    for (size_t i = 0; i < values.size(); i += 4) {
      pixels.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    }
  }
  return drawn;
}

/// How two pictures of one thing differ.
struct Difference {
  size_t shown = 0;     ///< pixels that are whole in both
  double coverage = 0;  ///< mean difference of alpha over all pixels that show something
  double unlike = 0;    ///< share of pixels whose radiance differs by more than a per cent of the mean
  double rms = 0;       ///< of the others, over the mean
};

Difference compare(const Pixels& a, const Pixels& b) {
  double mean = 0;
  size_t any = 0;
  Difference difference;
  for (size_t i = 0; i < a.size(); ++i) {
    any += a[i].a > 0 || b[i].a > 0;
    difference.coverage += std::abs(a[i].a - b[i].a);
    if (a[i].a < 1 || b[i].a < 1) continue;
    ++difference.shown;
    mean += (a[i].r + a[i].g + a[i].b) / 3;
  }
  mean /= static_cast<double>(difference.shown);
  size_t unlike = 0, alike = 0;
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].a < 1 || b[i].a < 1) continue;
    const double apart = glm::distance(glm::vec3(a[i]), glm::vec3(b[i])) / mean;
    apart > 0.01 ? ++unlike : ++alike;
    if (apart <= 0.01) squares += apart * apart;
  }
  difference.coverage /= static_cast<double>(any);
  difference.unlike = static_cast<double>(unlike) / static_cast<double>(difference.shown);
  difference.rms = std::sqrt(squares / static_cast<double>(alike));
  return difference;
}

TEST(NativeRaster, MakesTheSamePicturesAsOpenGl) {
  const auto by_gl = draw(Raster::kGl);
  const auto native = draw(Raster::kNative);
  for (const auto& [name, request] : requests()) {
    ASSERT_TRUE(by_gl.contains(name) && native.contains(name)) << name;
    const Difference difference = compare(by_gl.at(name), native.at(name));
    std::printf("%-28s %6zu px, coverage %.4f %%, rms %.4f %%, unlike %.3f %%\n", name.c_str(), difference.shown,
                100 * difference.coverage, 100 * difference.rms, 100 * difference.unlike);
    EXPECT_GT(difference.shown, 1000u) << name;
    EXPECT_LT(difference.coverage, 0.003) << name;
    EXPECT_LT(difference.rms, 0.001) << name;
    EXPECT_LT(difference.unlike, 0.005) << name;
  }
}

}  // namespace
}  // namespace diaphane::render

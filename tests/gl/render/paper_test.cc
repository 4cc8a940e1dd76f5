// The paper technique against sums made on the CPU, and its own figures.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glm/geometric.hpp"
#include "glm/gtc/matrix_transform.hpp"
#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"

namespace diaphane::render {
namespace {

const std::atomic<bool> kNotCancelled = false;
constexpr float kPi = std::numbers::pi_v<float>;

class Paper : public BothRasters {
 protected:
  /// Linear RGBA, rows top to bottom.
  static std::vector<glm::vec4> radiance(FrameRequest request) {
    request.format = PixelFormat::kLinearFloat;
    const absl::StatusOr<Frame> frame = renderer_->render(request, kNotCancelled);
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (!frame.ok()) return {};
    const auto& values = std::get<base::ImageF>(frame->image).values;
    std::vector<glm::vec4> pixels(values.size() / 4);
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
    }
    return pixels;
  }
};
INSTANTIATE_TEST_SUITE_P(, Paper, kBothRasters, name_of_raster);

constexpr uint32_t kSize_px = 64;

/// A marble plane of 20 mm through the origin with unit normal `n`, seen along it from 60 mm.
struct PlaneScene {
  glm::mat4 scene_from_mesh{1};
  glm::vec3 normal{0, 0, 1};
  glm::vec3 light{4, 3, 25};
  float intensity = 2000;

  FrameRequest request(uint32_t face_size_px, uint32_t taps) const {
    auto scene = make_scene(make_plane(20, 16), "marble");
    auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
    mesh->scene_from_mesh = scene_from_mesh;
    scene->meshes[0] = mesh;
    add_point_light(*scene, light, intensity);
    FrameRequest request;
    request.scene = scene;
    request.camera.eye = 60.0f * normal;
    request.camera.fov_y_deg = 10;
    request.width_px = request.height_px = kSize_px;
    request.settings.technique = Technique::kPaper;
    request.settings.paper = {.terms = Terms::kLocal, .kernel_taps = taps, .face_size_px = face_size_px};
    return request;
  }

  /// Where the ray through the centre of pixel (x, y), rows top to bottom, meets the plane.
  glm::vec3 point(uint32_t x, uint32_t y) const {
    const float half = 60 * std::tan(glm::radians(5.0f));
    const glm::vec3 right = glm::normalize(glm::cross(-normal, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, -normal);
    return half * ((2 * (static_cast<float>(x) + 0.5f) / kSize_px - 1) * right +
                   (1 - 2 * (static_cast<float>(y) + 0.5f) / kSize_px) * up);
  }

  glm::vec3 irradiance(const glm::vec3& p, float eta) const {
    const glm::vec3 to_light = light - p;
    const float cosine = std::max(0.0f, glm::dot(normal, glm::normalize(to_light)));
    return glm::vec3(intensity * cosine * optics::fresnel_transmittance(eta, cosine) / glm::dot(to_light, to_light));
  }

  /// The paper's taps, summed from the formulas: k = (N·f)·l, N×N points on the face projected back on the plane.
  glm::vec3 local_radiance(const glm::vec3& p, int taps) const {
    const optics::Coefficients marble = optics::find_preset("marble")->coefficients;
    const optics::Dipole dipole = optics::make_dipole(marble);
    const glm::vec3 l = dipole.mean_free_path_mm;
    int axis = 0;
    for (int a = 1; a < 3; ++a) axis = std::abs(normal[a]) > std::abs(normal[axis]) ? a : axis;
    const float product = std::abs(normal[axis]);
    const float spacing = 2 * product * (l.x + l.y + l.z) / 3 / static_cast<float>(taps);
    glm::vec3 sum(0);
    for (int j = 0; j < taps; ++j) {
      for (int i = 0; i < taps; ++i) {
        glm::vec3 offset(0);
        offset[(axis + 1) % 3] = spacing * (static_cast<float>(i) - 0.5f * static_cast<float>(taps - 1));
        offset[(axis + 2) % 3] = spacing * (static_cast<float>(j) - 0.5f * static_cast<float>(taps - 1));
        offset[axis] = -glm::dot(offset, normal) / normal[axis];
        sum += irradiance(p + offset, marble.refractive_index) *
               optics::diffuse_reflectance(dipole, glm::length(offset)) * (spacing * spacing / product);
      }
    }
    const float exit_cosine = glm::dot(normal, glm::normalize(60.0f * normal - p));
    return sum * optics::fresnel_transmittance(marble.refractive_index, exit_cosine) / kPi;
  }
};

PlaneScene tilted_plane() {
  PlaneScene plane;
  plane.scene_from_mesh = glm::rotate(glm::mat4(1), glm::radians(35.0f), glm::normalize(glm::vec3(0.4f, 1, 0)));
  plane.normal = glm::vec3(plane.scene_from_mesh * glm::vec4(0, 0, 1, 0));
  plane.light = 25.0f * plane.normal + glm::vec3(3, 2, 0);
  return plane;
}

void expect_local_sum_of_taps(const std::vector<glm::vec4>& pixels, const PlaneScene& plane, int taps) {
  ASSERT_EQ(pixels.size(), kSize_px * kSize_px);
  for (uint32_t y = 4; y < kSize_px; y += 8) {
    for (uint32_t x = 4; x < kSize_px; x += 8) {
      const glm::vec3 expected = plane.local_radiance(plane.point(x, y), taps);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(pixels[y * kSize_px + x][c] / expected[c], 1, 0.01) << x << "," << y << " channel " << c;
      }
    }
  }
}

TEST_P(Paper, LocalTermIsTheSumOfItsTapsOnAPlane) {
  for (const int taps : {3, 4, 5, 6}) {
    const PlaneScene plane;
    expect_local_sum_of_taps(radiance(plane.request(256, static_cast<uint32_t>(taps))), plane, taps);
  }
}

TEST_P(Paper, LocalTermIsTheSumOfItsTapsOnATiltedPlane) {
  const PlaneScene plane = tilted_plane();
  expect_local_sum_of_taps(radiance(plane.request(256, 5)), plane, 5);
}

TEST_P(Paper, BrightnessDoesNotFollowTheFaceSize) {
  for (const PlaneScene& plane : {PlaneScene{}, tilted_plane()}) {
    const auto coarse = radiance(plane.request(128, 5));
    const auto fine = radiance(plane.request(512, 5));
    ASSERT_EQ(coarse.size(), fine.size());
    for (size_t i = 0; i < fine.size(); ++i) {
      ASSERT_GT(fine[i].x, 0);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(coarse[i][c] / fine[i][c], 1, 0.03) << i;
    }
  }
}

/// Mean radiance of the front of a marble slab, `thickness` mean free paths thick, lit from behind by one point light.
glm::vec3 mean_behind_slab(const std::function<std::vector<glm::vec4>(FrameRequest)>& radiance, float thickness,
                           Technique technique, Terms terms) {
  const glm::vec3 l = optics::make_dipole(optics::find_preset("marble")->coefficients).mean_free_path_mm;
  const float depth_mm = thickness * (l.x + l.y + l.z) / 3;
  auto scene = make_scene(make_box({8, 8, depth_mm}, 8), "marble");
  add_point_light(*scene, {0, 0, -0.5f * depth_mm - 3}, 50);
  FrameRequest request;
  request.scene = scene;
  request.camera.eye = {0, 0, 40};
  request.camera.fov_y_deg = 8;
  request.width_px = request.height_px = kSize_px;
  request.settings.technique = technique;
  request.settings.paper.terms = terms;
  glm::vec3 sum(0);
  const auto pixels = radiance(request);
  for (const glm::vec4& pixel : pixels) sum += glm::vec3(pixel);
  return sum / static_cast<float>(pixels.size());
}

TEST_P(Paper, GlobalTermFallsWithTheThicknessOfASlab) {
  float last = INFINITY;
  for (const float thickness : {1.0f, 2.0f, 4.0f}) {
    const float mean = mean_behind_slab(radiance, thickness, Technique::kPaper, Terms::kGlobal).x;
    EXPECT_LT(mean, last) << thickness;
    EXPECT_GT(mean, 0) << thickness;
    last = mean;
  }
}

TEST_P(Paper, LambertIsBlackBehindASlab) {
  for (const float thickness : {1.0f, 2.0f, 4.0f}) {
    EXPECT_EQ(mean_behind_slab(radiance, thickness, Technique::kLambert, Terms::kBoth), glm::vec3(0)) << thickness;
  }
}

TEST_P(Paper, BothTermsAreTheSumOfEach) {
  FrameRequest request = PlaneScene{}.request(128, 5);
  const auto local = radiance(request);
  request.settings.paper.terms = Terms::kGlobal;
  const auto global = radiance(request);
  request.settings.paper.terms = Terms::kBoth;
  const auto both = radiance(request);
  for (size_t i = 0; i < both.size(); ++i) {
    EXPECT_GT(global[i].x, 0);
    EXPECT_NEAR(both[i].x, local[i].x + global[i].x, 1e-5f * both[i].x);
  }
}

TEST_P(Paper, GlobalGainScalesTheGlobalTerm) {
  FrameRequest request = PlaneScene{}.request(128, 5);
  request.settings.paper.terms = Terms::kGlobal;
  const auto one = radiance(request);
  request.settings.paper.global_gain = 3;
  const auto three = radiance(request);
  for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(three[i].x / one[i].x, 3, 1e-4f);
}

}  // namespace
}  // namespace diaphane::render

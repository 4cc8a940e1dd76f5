// What linear frames tell beside their colour, against the CPU.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"
#include "optics/profile.h"
#include "render/gl_renderer.h"
#include "scene/pick.h"
#include "tests/gl/render/scenes.h"

namespace diaphane::render {
namespace {

using ::testing::ElementsAre;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr Technique kAll[] = {Technique::kIntegral, Technique::kPaper, Technique::kReference, Technique::kLambert};
const std::vector<Channel> kEverything = {Channel::kIrradiance, Channel::kRadiosity, Channel::kNormal, Channel::kDepth,
                                          Channel::kPosition};

/// One pixel of a frame with kEverything.
struct Pixel {
  glm::vec4 colour;
  glm::vec3 irradiance, radiosity, normal;
  float depth;
  glm::vec3 position;
};

class Channels : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = make_gl_renderer({.warm_all = false});
    ASSERT_TRUE(made.ok()) << made.status();
    renderer_ = std::move(*made).release();
  }
  static void TearDownTestSuite() {
    delete renderer_;
    renderer_ = nullptr;
  }

  static base::ImageF draw(FrameRequest request, std::vector<Channel> channels) {
    request.format = PixelFormat::kLinearFloat;
    request.channels = std::move(channels);
    const absl::StatusOr<Frame> frame = renderer_->render(request, std::atomic<bool>(false));
    EXPECT_TRUE(frame.ok()) << frame.status();
    return frame.ok() ? std::get<base::ImageF>(frame->image) : base::ImageF{};
  }

  static std::vector<Pixel> pixels(const FrameRequest& request) {
    const base::ImageF image = draw(request, kEverything);
    std::vector<Pixel> pixels(image.values.size() / 17);
    const float* v = image.values.data();
    for (Pixel& pixel : pixels) {
      const auto vec = [&](int first) { return glm::vec3(v[first], v[first + 1], v[first + 2]); };
      pixel = {glm::vec4(vec(0), v[3]), vec(4), vec(7), vec(10), v[13], vec(14)};
      v += 17;
    }
    return pixels;
  }

  static inline FrameRenderer* renderer_ = nullptr;
};

constexpr uint32_t kSize_px = 32;

/// A marble ball of 10 mm radius where a scene unit is 2 mm.
FrameRequest ball_request(Technique technique) {
  auto scene = make_ball_scene(5, 24, "marble");
  scene->millimetres_per_unit = 2;
  add_point_light(*scene, {10, 12, 14}, 4000);
  FrameRequest request;
  request.scene = scene;
  request.camera = {{4, 3, 20}, {0.5f, 0, 0}, {0, 1, 0}, 35};
  request.width_px = request.height_px = kSize_px;
  request.settings.technique = technique;
  return request;
}

/// From the eye through the centre of pixel (x, y), rows top to bottom; one unit deep along the view axis.
glm::vec3 ray(const FrameRequest& request, uint32_t x, uint32_t y) {
  const scene::Camera& camera = request.camera;
  const glm::vec3 axis = glm::normalize(camera.target - camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(axis, camera.up));
  const glm::vec3 up = glm::cross(right, axis);
  const float half = std::tan(glm::radians(camera.fov_y_deg) / 2);
  const float aspect = static_cast<float>(request.width_px) / static_cast<float>(request.height_px);
  const float u = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(request.width_px) - 1;
  const float v = 1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(request.height_px);
  return axis + half * (aspect * u * right + v * up);
}

TEST_F(Channels, TellWhereABallIsInTheScenesFrame) {
  for (const Technique technique : kAll) {
    SCOPED_TRACE(static_cast<int>(technique));
    const FrameRequest request = ball_request(technique);
    const auto all = pixels(request);
    ASSERT_EQ(all.size(), kSize_px * kSize_px);
    size_t shown = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      const Pixel& pixel = all[i];
      if (pixel.colour.a == 0) {
        EXPECT_EQ(pixel.irradiance + pixel.radiosity + pixel.normal + pixel.position, glm::vec3(0));
        EXPECT_EQ(pixel.depth, INFINITY);
        continue;
      }
      ++shown;
      EXPECT_NEAR(glm::length(pixel.position), 5, 0.01f);
      EXPECT_NEAR(glm::length(pixel.normal), 1, 1e-5f);
      EXPECT_GT(glm::dot(pixel.normal, glm::normalize(pixel.position)), 0.9999f);
      const glm::vec3 along = ray(request, i % kSize_px, static_cast<uint32_t>(i / kSize_px));
      EXPECT_LT(glm::distance(request.camera.eye + pixel.depth * along, pixel.position), 2e-4f * pixel.depth) << i;
    }
    EXPECT_GT(shown, 200u);
    EXPECT_LT(shown, all.size());
  }
}

TEST_F(Channels, DepthIsMeasuredAlongTheViewAxis) {
  auto scene = make_scene(make_plane(200, 4), "marble");
  scene->millimetres_per_unit = 0.5;
  FrameRequest request;
  request.scene = scene;
  request.camera = {{0, 0, 60}, {0, 0, 0}, {0, 1, 0}, 50};
  request.width_px = 24;
  request.height_px = 16;
  for (const Technique technique : kAll) {
    request.settings.technique = technique;
    const base::ImageF image = draw(request, {Channel::kDepth});
    EXPECT_THAT(image.channels, ElementsAre("R", "G", "B", "A", "Z"));
    for (size_t i = 0; i < image.values.size(); i += 5) {
      EXPECT_NEAR(image.values[i + 4], 60, 1e-3f);
    }
  }
}

TEST_F(Channels, NormalsOfAnOpenSurfaceLookAtTheEyeFromBothSides) {
  for (const float mirror : {1.0f, -1.0f}) {
    auto scene = make_scene(make_plane(200, 4), "marble");
    auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
    mesh->scene_from_mesh[0][0] = mirror;
    scene->meshes[0] = mesh;
    FrameRequest request;
    request.scene = scene;
    request.width_px = request.height_px = 8;
    request.settings.technique = Technique::kLambert;
    for (const float side : {1.0f, -1.0f}) {
      request.camera = {{0, 0, 60 * side}, {0, 0, 0}, {0, 1, 0}, 50};
      for (const Pixel& pixel : pixels(request)) {
        EXPECT_NEAR(pixel.normal.z, side, 1e-5f) << mirror;
      }
    }
  }
}

TEST_F(Channels, IrradianceOfAPlaneIsWhatEntersOfTheLight) {
  const glm::vec3 light(4, 3, 25);
  auto scene = make_scene(make_plane(20, 32), "marble");
  add_point_light(*scene, light, 2000);
  FrameRequest request;
  request.scene = scene;
  request.camera = {{0, 0, 60}, {0, 0, 0}, {0, 1, 0}, 15};
  request.width_px = request.height_px = kSize_px;
  const float eta = scene->materials[0].coefficients.refractive_index;
  for (const Technique technique : kAll) {
    SCOPED_TRACE(static_cast<int>(technique));
    request.settings.technique = technique;
    for (const bool shadows : {false, true}) {
      request.settings.shadows = shadows;
      for (const Pixel& pixel : pixels(request)) {
        const glm::vec3 to_light = light - pixel.position;
        const float cosine = glm::normalize(to_light).z;
        const float entering = technique == Technique::kLambert ? 1 : optics::fresnel_transmittance(eta, cosine);
        const float expected = 2000 * cosine * entering / glm::dot(to_light, to_light);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel.irradiance[c] / expected, 1, 0.002f);
      }
    }
  }
}

TEST_F(Channels, ColourIsWhatLeavesOfTheRadiosity) {
  for (const Technique technique : kAll) {
    SCOPED_TRACE(static_cast<int>(technique));
    const FrameRequest request = ball_request(technique);
    const optics::Coefficients& marble = request.scene->materials[0].coefficients;
    for (const Pixel& pixel : pixels(request)) {
      if (pixel.colour.a == 0) continue;
      glm::vec3 expected = pixel.radiosity / kPi;
      if (technique == Technique::kLambert) {
        const glm::vec3 reflected = optics::total_reflectance(marble) * pixel.irradiance;
        EXPECT_LT(glm::distance(pixel.radiosity, reflected), 1e-5f * (1 + glm::length(reflected)));
      } else {
        const glm::vec3 to_eye = glm::normalize(request.camera.eye - pixel.position);
        const float cosine = std::abs(glm::dot(pixel.normal, to_eye));
        // At the rim the transmittance is too steep for the cosine's last digits.
        if (cosine < 0.1f) continue;
        expected *= optics::fresnel_transmittance(marble.refractive_index, cosine);
      }
      EXPECT_LT(glm::distance(glm::vec3(pixel.colour), expected), 1e-3f * glm::length(expected) + 1e-7f);
    }
  }
}

TEST_F(Channels, LeaveTheColourAsItIs) {
  for (const Technique technique : kAll) {
    const FrameRequest request = ball_request(technique);
    const base::ImageF plain = draw(request, {});
    EXPECT_THAT(plain.channels, ElementsAre("R", "G", "B", "A"));
    const auto all = pixels(request);
    ASSERT_EQ(plain.values.size(), 4 * all.size());
    for (size_t i = 0; i < all.size(); ++i) {
      for (int c = 0; c < 4; ++c) {
        const float value = plain.values[4 * i + c];
        EXPECT_NEAR(all[i].colour[c], value, 1e-6f * value) << i;
      }
    }
  }
}

TEST_F(Channels, StandInTheOrderInWhichTheyWereAsked) {
  const base::ImageF image =
      draw(ball_request(Technique::kLambert), {Channel::kPosition, Channel::kRadiosity, Channel::kNormal});
  EXPECT_THAT(image.channels, ElementsAre("R", "G", "B", "A", "P.X", "P.Y", "P.Z", "radiosity.R", "radiosity.G",
                                          "radiosity.B", "N.X", "N.Y", "N.Z"));
}

TEST_F(Channels, AgreeAcrossTiles) {
  FrameRequest request = ball_request(Technique::kIntegral);
  request.width_px = 2080;
  request.height_px = 8;
  request.camera.fov_y_deg = 1;
  request.camera.target = {4.9f, 0, 0};
  request.camera.eye = {4.9f, 0, 20};
  const auto all = pixels(request);
  ASSERT_EQ(all.size(), size_t{2080} * 8);
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].colour.a == 0) continue;
    const glm::vec3 along = ray(request, i % 2080, static_cast<uint32_t>(i / 2080));
    EXPECT_LT(glm::distance(request.camera.eye + all[i].depth * along, all[i].position), 2e-4f * all[i].depth) << i;
  }
}

TEST_F(Channels, CostFramesWithoutThemNothing) {
  FrameRequest request = ball_request(Technique::kIntegral);
  request.format = PixelFormat::kLinearFloat;
  const auto frame = renderer_->render(request, std::atomic<bool>(false));
  ASSERT_TRUE(frame.ok()) << frame.status();
  for (const StageTime& stage : frame->stages) EXPECT_NE(stage.stage, "gbuffer");
}

TEST_F(Channels, PickingFindsThePointThatThePictureShows) {
  const FrameRequest request = ball_request(Technique::kLambert);
  const std::vector<Pixel> frame = pixels(request);
  int shown = 0;
  for (uint32_t y = 0; y < kSize_px; ++y) {
    for (uint32_t x = 0; x < kSize_px; ++x) {
      const Pixel& pixel = frame[y * kSize_px + x];
      const auto picked = scene::pick(*request.scene, request.camera, {kSize_px, kSize_px}, glm::vec2(x, y) + 0.5f);
      // A pixel on the rim may fall to either side.
      if (picked.has_value() != (pixel.colour.a > 0)) {
        const bool rim = picked.has_value() && std::abs(picked->facet_normal.z) < 0.3;
        EXPECT_TRUE(rim) << x << " " << y;
        continue;
      }
      if (!picked.has_value()) continue;
      ++shown;
      EXPECT_LT(glm::distance(glm::vec3(picked->position), pixel.position), 2e-3f) << x << " " << y;
    }
  }
  EXPECT_GT(shown, 200);
}

}  // namespace
}  // namespace diaphane::render

// Frames of scenes in an environment.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "glm/gtc/matrix_transform.hpp"
#include "glm/trigonometric.hpp"
#include "render/ambient.h"
#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"

namespace diaphane::render {
namespace {

class EnvironmentFrames : public SharedRenderer {
 protected:
  static std::shared_ptr<const scene::Environment> environment_of(
      const std::function<glm::vec3(const glm::vec3&)>& radiance, float rotation_deg = 0, float intensity = 1) {
    optics::LatLongMap map{128, 64, {}};
    for (uint32_t y = 0; y < map.height_px; ++y) {
      for (uint32_t x = 0; x < map.width_px; ++x) map.radiance.push_back(radiance(map.direction(x, y)));
    }
    auto light = std::make_shared<const optics::EnvironmentLight>(optics::analyse(map));
    return std::make_shared<const scene::Environment>(scene::Environment{
        "e", std::make_shared<const optics::LatLongMap>(std::move(map)), std::move(light), rotation_deg, intensity});
  }

  static FrameRequest request_of(std::shared_ptr<const scene::SceneSnapshot> scene, Technique technique) {
    FrameRequest request;
    request.scene = std::move(scene);
    request.camera = {{3, 10, 25}, {0, 0, 0}, {0, 1, 0}, 30};
    request.width_px = 48;
    request.height_px = 32;
    request.settings.technique = technique;
    request.settings.paper.face_size_px = 64;
    request.format = PixelFormat::kLinearFloat;
    return request;
  }
};

TEST_F(EnvironmentFrames, OfOneRadianceEnterEverywhereAlike) {
  auto scene = make_scene(make_box({10, 10, 10}, 8), "marble");  // η 1.5
  scene->environment = environment_of([](const glm::vec3&) { return glm::vec3(3, 2, 1); }, 0, 0.5f);
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper, Technique::kReference}) {
    FrameRequest request = request_of(scene, technique);
    request.channels = {Channel::kIrradiance};
    const std::vector<float> values = render(request);
    size_t shown = 0;
    for (size_t i = 0; i < values.size(); i += 7) {
      if (values[i + 3] == 0) continue;
      ++shown;
      ASSERT_NEAR(values[i + 4], 1.5f * 2.8533f, 0.01f);
      ASSERT_NEAR(values[i + 6], 0.5f * 2.8533f, 0.004f);
    }
    EXPECT_GT(shown, 100u);
  }
}

/// Each pixel's E with occlusion over E without.
std::vector<float> open_shares(const std::vector<float>& occluded, const std::vector<float>& open) {
  std::vector<float> shares;
  for (size_t i = 0; i < open.size(); i += 7) shares.push_back(open[i + 3] == 0 ? -1 : occluded[i + 5] / open[i + 5]);
  return shares;
}

/// Of the floor below: the share of E that a wall of 20 mm at `away_mm` leaves, by quadrature. The sky is 2 + y.
float open_share_beside_a_wall(float away_mm, float refractive_index) {
  constexpr int kSteps = 400;
  double all = 0, open = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float y = (static_cast<float>(i) + 0.5f) / kSteps;
    const double entering = y * (2 + y) * optics::fresnel_transmittance(refractive_index, y);
    for (int j = 0; j < kSteps; ++j) {
      const float angle = glm::radians(360 * (static_cast<float>(j) + 0.5f) / kSteps), side = std::sqrt(1 - y * y);
      const float x = side * std::cos(angle), z = side * std::sin(angle);
      const float far = away_mm / -x;  // to the wall's plane
      const bool hidden = x < 0 && far * y < 20 && std::abs(far * z) < 20;
      all += entering;
      open += hidden ? 0 : entering;
    }
  }
  return static_cast<float>(open / all);
}

TEST_F(EnvironmentFrames, AreHiddenByAWallFromItsFootAndByNothingFromABall) {
  // A floor of 40 mm with a wall of 20 mm across its middle, seen from above: 2.86 pixels a millimetre.
  Triangles floor = make_box({40, 2, 40}, 40), wall = make_box({2, 20, 40}, 20);
  const auto first = static_cast<uint32_t>(floor.positions.size());
  for (const glm::vec3& p : wall.positions) floor.positions.push_back(p + glm::vec3(-1, 11, 0));
  for (const glm::uvec3& t : wall.triangles) floor.triangles.push_back(t + first);
  for (const bool ball : {false, true}) {
    auto scene = ball ? make_ball_scene(6, 24, "marble") : make_scene(floor, "marble");
    const auto sky = [](const glm::vec3& d) { return glm::vec3(2 + d.y); };
    for (const Technique technique :
         {Technique::kIntegral, Technique::kPaper, Technique::kLambert, Technique::kReference}) {
      FrameRequest request = request_of(scene, technique);
      request.camera = {{8, 160, 0}, {8, 0, 0}, {0, 0, -1}, 4};
      if (ball) request.camera = {{8, 160, 0}, {0, 0, 0}, {0, 0, -1}, 6};
      request.channels = {Channel::kIrradiance};
      const auto open = environment_of(sky);
      auto occluded = std::make_shared<scene::Environment>(*open);
      occluded->occlusion = true;
      scene->environment = open;
      const std::vector<float> without = render(request);
      scene->environment = occluded;
      const std::vector<float> shares = open_shares(render(request), without);
      if (ball) {
        for (const float share : shares) {
          if (share < 0) continue;
          EXPECT_NEAR(share, 1, 0.03f) << static_cast<int>(technique);
        }
        continue;
      }
      const float eta = technique == Technique::kLambert ? 1.0f : 1.5f;
      // Of 48 directions, two or three weigh as much as this; the reference has four times as many.
      const float error = technique == Technique::kReference ? 0.03f : 0.06f;
      for (const size_t column : {8, 14, 24, 40}) {
        const float x = 8 + (static_cast<float>(column) + 0.5f - 24) * 0.35f;
        EXPECT_NEAR(shares[16 * 48 + column], open_share_beside_a_wall(x, eta), error)
            << static_cast<int>(technique) << ", column " << column;
      }
    }
  }
}

TEST_F(EnvironmentFrames, AreSeenBehindTheBodyWhereTheirLightComesFrom) {
  auto scene = make_scene(make_box({10, 10, 10}, 4), "marble");
  // Each way has a colour of its own.
  scene->environment = environment_of([](const glm::vec3& d) { return 2.0f + d; }, 0, 0.5f);
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper, Technique::kReference}) {
    FrameRequest request = request_of(scene, technique);
    request.camera = {{0, 0, 25}, {0, 0, 0}, {0, 1, 0}, 90};
    const std::vector<float> without = render(request);
    request.settings.environment_background = true;
    const std::vector<float> with = render(request);
    size_t behind = 0;
    for (size_t i = 0; i < with.size(); i += 4) {
      EXPECT_EQ(with[i + 3], 1);
      const size_t pixel = i / 4;
      if (without[i + 3] == 1) {
        EXPECT_EQ(with[i], without[i]);
        continue;
      }
      ++behind;
      // Half the height of the picture is as wide as the eye is far: tan 45° = 1.
      const glm::vec3 way = glm::normalize(glm::vec3((static_cast<float>(pixel % 48) + 0.5f - 24) / 16,
                                                     (15.5f - static_cast<float>(pixel / 48)) / 16, -1));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(with[i + c], 0.5f * (2 + way[c]), 0.003f) << pixel;
    }
    EXPECT_GT(behind, 500u);
    EXPECT_LT(behind, 48u * 32u);
  }
}

TEST_F(EnvironmentFrames, AreSeenTurned) {
  auto scene = make_scene(make_box({10, 10, 10}, 4), "marble");
  // A lamp at -z: straight ahead. It turns about +y, counter-clockwise seen from above: to the left.
  const auto lamp = [](const glm::vec3& d) { return glm::vec3(d.z < -0.98f ? 5.0f : 0.0f); };
  scene->environment = environment_of(lamp, 60);
  FrameRequest request = request_of(scene, Technique::kIntegral);
  request.camera = {{0, 0, 25}, {-std::sin(glm::radians(60.0f)), 0, 25 - 0.5f}, {0, 1, 0}, 60};
  request.settings.environment_background = true;
  request.settings.samples = 4;
  const std::vector<float> seen = render(request);
  EXPECT_NEAR(seen[4 * (16 * 48 + 24)], 5, 1e-4);
  EXPECT_EQ(seen[0], 0);
}

TEST_F(EnvironmentFrames, ThatAreNotThereCannotBeTheBackground) {
  FrameRequest request = request_of(make_scene(make_box({10, 10, 10}, 4), "marble"), Technique::kIntegral);
  request.settings.environment_background = true;
  const auto frame = renderer_->render(request, std::atomic<bool>(false));
  EXPECT_EQ(frame.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(frame.status().message()), testing::HasSubstr("settings.background.environment"));
}

TEST_F(EnvironmentFrames, LightLambertWithoutFresnel) {
  auto scene = make_scene(make_box({10, 10, 10}, 4), "marble");
  scene->environment = environment_of([](const glm::vec3&) { return glm::vec3(1); });
  FrameRequest request = request_of(scene, Technique::kLambert);
  request.channels = {Channel::kIrradiance};
  const std::vector<float> values = render(request);
  EXPECT_NEAR(values[7 * (16 * 48 + 24) + 4], 3.1416f, 0.01f);
}

glm::vec3 sky_with_a_sun(const glm::vec3& d) {
  const bool sun = glm::dot(d, glm::normalize(glm::vec3(0.5f, 0.7f, 0.5f))) > 0.995f;
  return glm::vec3(0.2f, 0.3f, 0.5f + 0.3f * d.y) + (sun ? glm::vec3(90, 80, 70) : glm::vec3(0));
}

TEST_F(EnvironmentFrames, StayTheSameWhenMapAndSceneTurnTogether) {
  auto scene = make_scene(make_box({10, 6, 8}, 16), "skin1");
  scene->environment = environment_of(sky_with_a_sun);
  ASSERT_EQ(scene->environment->light->lamps.size(), 1u);
  constexpr float kTurn_deg = 67;
  auto turned = std::make_shared<scene::SceneSnapshot>(*scene);
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  mesh->scene_from_mesh = glm::rotate(glm::mat4(1), glm::radians(kTurn_deg), glm::vec3(0, 1, 0));
  turned->meshes[0] = std::move(mesh);
  auto environment = std::make_shared<scene::Environment>(*scene->environment);
  environment->rotation_deg = kTurn_deg;
  turned->environment = std::move(environment);
  for (const Technique technique : {Technique::kIntegral, Technique::kLambert}) {
    const FrameRequest request = request_of(scene, technique);
    FrameRequest other = request;
    other.scene = turned;
    other.camera.eye = rotated_about_y(request.camera.eye, kTurn_deg);
    const std::vector<float> before = render(request), after = render(other);
    double squares = 0, sum = 0;
    for (size_t i = 0; i < before.size(); ++i) {
      squares += std::pow(before[i] - after[i], 2);
      sum += before[i];
    }
    const auto count = static_cast<double>(before.size());
    EXPECT_LT(std::sqrt(squares / count), 0.003 * sum / count);
  }
}

TEST_F(EnvironmentFrames, TurnWithTheMapAlone) {
  auto scene = make_scene(make_box({10, 10, 10}, 8), "marble");
  scene->environment = environment_of(sky_with_a_sun);
  const FrameRequest request = request_of(scene, Technique::kIntegral);
  const std::vector<float> before = render(request);
  auto turned = std::make_shared<scene::SceneSnapshot>(*scene);
  auto environment = std::make_shared<scene::Environment>(*scene->environment);
  environment->rotation_deg = 180;
  turned->environment = std::move(environment);
  FrameRequest other = request;
  other.scene = turned;
  const size_t centre = 4 * (16 * 48 + 24);
  EXPECT_LT(render(other)[centre], 0.7f * before[centre]);
  // And back again, to the byte.
  EXPECT_EQ(render(request), before);
}

TEST_F(EnvironmentFrames, HaveTheShadowOfTheirSun) {
  auto scene = make_scene(make_box({10, 10, 10}, 8), "marble");
  scene->environment = environment_of([](const glm::vec3& d) { return glm::vec3(d.y > 0.995f ? 100.0f : 0.1f); });
  ASSERT_EQ(scene->environment->light->lamps.size(), 1u);
  auto hidden = std::make_shared<scene::SceneSnapshot>(*scene);
  const auto roof = make_scene(make_plane(60, 4), "marble");
  auto mesh = std::make_shared<scene::Mesh>(*roof->meshes[0]);
  mesh->name = "roof";
  mesh->scene_from_mesh =
      glm::rotate(glm::translate(glm::mat4(1), glm::vec3(0, 40, 0)), glm::radians(90.0f), glm::vec3(1, 0, 0));
  hidden->meshes.push_back(std::move(mesh));
  FrameRequest request = request_of(scene, Technique::kIntegral);
  request.channels = {Channel::kIrradiance};
  request.camera.eye = {3, 30, 15};
  const size_t centre = 7 * (16 * 48 + 24) + 4;
  const float in_the_sun = render(request)[centre];
  request.scene = hidden;
  const float in_the_shade = render(request)[centre];
  EXPECT_GT(in_the_sun, 3 * in_the_shade);
  EXPECT_GT(in_the_shade, 0.2f);
}

}  // namespace
}  // namespace diaphane::render

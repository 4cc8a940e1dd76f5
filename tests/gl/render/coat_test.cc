// What coats add to frames.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "optics/dipole.h"
#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"

namespace diaphane::render {
namespace {

constexpr uint32_t kWidth = 48, kHeight = 32;
constexpr float kTurnedAway = 0.01f;  // the cosine to the eye below which an interpolated normal is a silhouette's

class CoatedFrames : public SharedRenderer {
 protected:
  static std::shared_ptr<const scene::Environment> environment_of(
      const std::function<glm::vec3(const glm::vec3&)>& radiance, float intensity) {
    optics::LatLongMap map{256, 128, {}};
    for (uint32_t y = 0; y < map.height_px; ++y) {
      for (uint32_t x = 0; x < map.width_px; ++x) map.radiance.push_back(radiance(map.direction(x, y)));
    }
    auto light = std::make_shared<const optics::EnvironmentLight>(optics::EnvironmentLight{optics::project(map), {}});
    return std::make_shared<const scene::Environment>(scene::Environment{
        "e", std::make_shared<const optics::LatLongMap>(std::move(map)), std::move(light), 0, intensity});
  }

  static FrameRequest request_of(std::shared_ptr<const scene::SceneSnapshot> scene,
                                 Technique technique = Technique::kIntegral) {
    FrameRequest request;
    request.scene = std::move(scene);
    request.camera = {{0, 0, 25}, {0, 0, 0}, {0, 1, 0}, 30};
    request.width_px = kWidth;
    request.height_px = kHeight;
    request.settings.technique = technique;
    request.settings.paper.face_size_px = 64;
    request.format = PixelFormat::kLinearFloat;
    request.channels = {Channel::kPosition, Channel::kNormal};
    return request;
  }

  static std::shared_ptr<const scene::SceneSnapshot> coated(const scene::SceneSnapshot& scene, float roughness) {
    auto with = std::make_shared<scene::SceneSnapshot>(scene);
    for (scene::Material& material : with->materials) material.coat = optics::Coat{roughness};
    return with;
  }

  /// What the coat adds at every shown pixel, where it is, and its normal.
  struct Added {
    glm::vec3 light, position, normal;
  };
  static std::vector<Added> added_by_coat(const scene::SceneSnapshot& scene, float roughness, FrameRequest request) {
    request.scene = std::make_shared<scene::SceneSnapshot>(scene);
    const std::vector<float> bare = render(request);
    request.scene = coated(scene, roughness);
    const std::vector<float> with = render(request);
    std::vector<Added> added;
    for (size_t i = 0; i < bare.size(); i += 10) {
      const auto three = [&](const std::vector<float>& v, size_t at) {
        return glm::vec3(v[i + at], v[i + at + 1], v[i + at + 2]);
      };
      EXPECT_EQ(bare[i + 3], with[i + 3]);
      if (bare[i + 3] > 0) added.push_back({three(with, 0) - three(bare, 0), three(with, 4), three(with, 7)});
    }
    EXPECT_GT(added.size(), 100u);
    return added;
  }
};

TEST_F(CoatedFrames, OfMirrorsShowTheEnvironmentWhereItShouldBe) {
  auto scene = make_scene(make_box({8, 6, 6}, 8), "marble");  // η 1.5
  // Each way has a colour of its own.
  scene->environment = environment_of([](const glm::vec3& d) { return 2.0f + d; }, 0.5f);
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper, Technique::kReference}) {
    FrameRequest request = request_of(scene, technique);
    request.camera.eye = {12, 9, 20};
    for (const Added& at : added_by_coat(*scene, 0, request)) {
      const glm::vec3 from_eye = glm::normalize(at.position - request.camera.eye);
      const float cosine = -glm::dot(from_eye, at.normal);
      if (cosine < kTurnedAway) continue;
      const float reflected = 1 - optics::fresnel_transmittance(1.5f, cosine);
      const glm::vec3 expected = 0.5f * reflected * (2.0f + glm::reflect(from_eye, at.normal));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(at.light[c], expected[c], 0.01f * expected[c] + 1e-4f) << cosine;
    }
  }
}

TEST_F(CoatedFrames, ReflectOfEvenLightWhatDoesNotEnterAtAnyRoughness) {
  auto scene = make_scene(make_box({8, 6, 6}, 8), "skin1");  // η 1.3
  scene->environment = environment_of([](const glm::vec3&) { return glm::vec3(3, 2, 1); }, 1);
  for (const float roughness : {0.0f, 0.2f, 1.0f}) {
    FrameRequest request = request_of(scene);
    request.camera.eye = {12, 9, 20};
    for (const Added& at : added_by_coat(*scene, roughness, request)) {
      const float cosine = glm::dot(glm::normalize(request.camera.eye - at.position), at.normal);
      if (cosine < kTurnedAway) continue;
      const float reflected = 1 - optics::fresnel_transmittance(1.3f, cosine);
      EXPECT_NEAR(at.light.r, 3 * reflected, 0.01f * reflected + 1e-4f);
    }
  }
}

TEST_F(CoatedFrames, HaveAHighlightWhereALightIsMirroredUnlessSomethingHidesTheLight) {
  auto scene = make_scene(make_plane(20, 16), "marble");
  add_point_light(*scene, {6, 0, 25}, 1000);
  FrameRequest request = request_of(scene);
  const auto brightest = [](const std::vector<Added>& added) {
    return *std::max_element(added.begin(), added.end(),
                             [](const Added& a, const Added& b) { return a.light.g < b.light.g; });
  };
  // Eye and light are as far from the plane: the highlight is half way between.
  const Added at = brightest(added_by_coat(*scene, 0.05f, request));
  EXPECT_NEAR(at.position.x, 3, 0.5f);
  EXPECT_NEAR(at.position.y, 0, 0.5f);
  EXPECT_GT(at.light.g, 0.05f);
  const Added rougher = brightest(added_by_coat(*scene, 0.3f, request));
  EXPECT_LT(rougher.light.g, 0.2f * at.light.g);

  // A small screen half way to the light.
  auto screen = make_scene(make_box({3, 3, 0.2f}, 2), "marble");
  auto mesh = std::make_shared<scene::Mesh>(*screen->meshes[0]);
  mesh->name = "screen";
  mesh->scene_from_mesh[3] = glm::vec4(4.5f, 0, 12.5f, 1);
  auto hidden = std::make_shared<scene::SceneSnapshot>(*scene);
  hidden->meshes.push_back(std::move(mesh));
  double lit = 0, shadowed = 0;
  for (const auto& [of, sum] : {std::pair(scene.get(), &lit), std::pair(hidden.get(), &shadowed)}) {
    for (const Added& point : added_by_coat(*of, 0.05f, request)) {
      if (std::abs(point.position.z) < 0.01f && std::hypot(point.position.x - 3, point.position.y) < 1) {
        *sum += point.light.g;
      }
    }
  }
  EXPECT_LT(shadowed, 0.05 * lit);
}

TEST_F(CoatedFrames, AreTheSameInPicturesAndLinearPixels) {
  auto scene = make_scene(make_box({8, 6, 6}, 8), "marble");
  scene->environment = environment_of([](const glm::vec3& d) { return 0.3f * (2.0f + d); }, 1);
  FrameRequest request = request_of(coated(*scene, 0.3f));
  request.channels.clear();
  const std::vector<float> linear = render(request);
  request.format = PixelFormat::kSrgb8;
  auto frame = renderer_->render(request, std::atomic<bool>(false));
  ASSERT_TRUE(frame.ok()) << frame.status();
  const std::vector<uint8_t>& picture = std::get<base::Image8>(frame->image).rgba;
  const size_t centre = 4 * (kHeight / 2 * kWidth + kWidth / 2);
  const float v = std::min(linear[centre], 1.0f);
  EXPECT_NEAR(picture[centre], 255 * (1.055f * std::pow(v, 1 / 2.4f) - 0.055f), 1);
  EXPECT_TRUE(std::any_of(frame->stages.begin(), frame->stages.end(),
                          [](const StageTime& stage) { return stage.stage == "coat" && stage.ran; }));
}

TEST_F(CoatedFrames, DoNotKeepAnEnvironmentThatTheSceneHasLost) {
  auto scene = make_scene(make_box({8, 6, 6}, 4), "marble");
  scene->environment = environment_of([](const glm::vec3&) { return glm::vec3(1); }, 1);
  const std::weak_ptr<const optics::LatLongMap> map = scene->environment->map;
  render(request_of(coated(*scene, 0.3f)));
  scene.reset();
  EXPECT_TRUE(map.expired());
}

TEST_F(CoatedFrames, OfLambertHaveNone) {
  auto scene = make_scene(make_box({8, 6, 6}, 4), "marble");
  const FrameRequest request = request_of(scene, Technique::kLambert);
  for (const Added& at : added_by_coat(*scene, 0.1f, request)) EXPECT_EQ(at.light, glm::vec3(0));
}

}  // namespace
}  // namespace diaphane::render

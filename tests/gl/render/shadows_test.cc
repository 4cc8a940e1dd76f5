// Shadows of the techniques whose shaders know none.
#include <gtest/gtest.h>

#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"

namespace diaphane::render {
namespace {

class LitByVertices : public ::testing::TestWithParam<Technique> {
 protected:
  void SetUp() override {
    auto made = make_gl_renderer({.warm_all = false});
    ASSERT_TRUE(made.ok()) << made.status();
    renderer_ = *std::move(made);
  }

  /// A marble ball of 5 mm at the origin, seen from the side; light from above.
  FrameRequest ball_request() const {
    auto scene = make_ball_scene(5, 24, "marble");
    add_point_light(*scene, {0, 0, 60}, 8000);
    FrameRequest request;
    request.scene = scene;
    request.camera = {{20, 5, 30}, {0, 0, 0}, {0, 1, 0}, 30};
    request.width_px = request.height_px = 48;
    request.settings.technique = GetParam();
    request.format = PixelFormat::kLinearFloat;
    return request;
  }

  /// The same, with a plate between it and the light, outside the picture.
  FrameRequest blocked_request(float plate_z = 40) const {
    FrameRequest request = ball_request();
    auto scene = std::make_shared<scene::SceneSnapshot>(*request.scene);
    const auto plate_scene = make_scene(make_box({30, 30, 1}, 2), "marble");
    auto plate = std::make_shared<scene::Mesh>(*plate_scene->meshes[0]);
    plate->name = "scenes/test/meshes/plate";
    plate->scene_from_mesh[3] = glm::vec4(0, 0, plate_z, 1);
    scene->meshes.push_back(plate);
    request.scene = scene;
    return request;
  }

  Frame render(const FrameRequest& request) {
    absl::StatusOr<Frame> frame = renderer_->render(request, std::atomic<bool>(false));
    EXPECT_TRUE(frame.ok()) << frame.status();
    return frame.ok() ? *std::move(frame) : Frame{base::ImageF{}};
  }
  std::vector<float> values(const FrameRequest& request) {
    return std::get<base::ImageF>(render(request).image).values;
  }
  double brightness(const FrameRequest& request) {
    double sum = 0;
    const std::vector<float> v = values(request);
    for (size_t i = 0; i < v.size(); i += 4) sum += v[i] + v[i + 1] + v[i + 2];
    return sum;
  }

  std::unique_ptr<FrameRenderer> renderer_;
};

TEST_P(LitByVertices, DarkenABodyBehindABlocker) {
  FrameRequest request = blocked_request();
  request.settings.shadows = false;
  const double bright = brightness(request);
  EXPECT_GT(bright, 1);
  request.settings.shadows = true;
  EXPECT_LT(brightness(request), 1e-3 * bright);
}

TEST_P(LitByVertices, LeaveABodyThatNothingHidesAsItIs) {
  FrameRequest request = ball_request();
  const double without = brightness(request);
  request.settings.shadows = true;
  EXPECT_NEAR(brightness(request) / without, 1, 0.02);
}

TEST_P(LitByVertices, AreOffUnlessAskedFor) {
  FrameRequest request = blocked_request();
  const std::vector<float> unasked = values(request);
  request.settings.shadows = false;
  EXPECT_EQ(values(request), unasked);
  request.settings.shadows = true;
  values(request);
  request.settings.shadows = false;
  EXPECT_EQ(values(request), unasked);
}

TEST_P(LitByVertices, FollowTheBlocker) {
  FrameRequest request = blocked_request();
  request.settings.shadows = true;
  const double dark = brightness(request);
  const std::vector<StageTime> again = render(request).stages;
  for (const StageTime& stage : again) {
    if (stage.stage == "irradiance" || stage.stage == "atlas") {
      EXPECT_FALSE(stage.ran) << stage.stage;
    }
  }
  // Beyond the light.
  EXPECT_GT(brightness([&] {
              FrameRequest moved = blocked_request(80);
              moved.settings.shadows = true;
              return moved;
            }()),
            100 * dark + 1);
}

TEST_P(LitByVertices, ForgetABlockerThatIsGone) {
  const auto shadowed = [&](float plate_z) {
    FrameRequest request = blocked_request(plate_z);
    request.settings.shadows = true;
    return brightness(request);
  };
  // Each scene is gone when the next one, whose meshes have the same names, is drawn.
  const double dark = shadowed(40);
  EXPECT_GT(shadowed(80), 100 * dark + 1);
  EXPECT_EQ(shadowed(40), dark);
}

INSTANTIATE_TEST_SUITE_P(Techniques, LitByVertices, ::testing::Values(Technique::kPaper, Technique::kLambert),
                         [](const auto& info) { return info.param == Technique::kPaper ? "Paper" : "Lambert"; });

}  // namespace
}  // namespace diaphane::render

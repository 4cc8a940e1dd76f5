// Whole pictures against the independent ground truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"
#include "tests/support/reference_scenes.h"

namespace diaphane::render {
namespace {

struct Bar {
  Technique technique;
  diffusion::Quality quality;
  float unshadowed;
  float shadowed;
};

class Truth : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    scene_ = diaphane::testing::load_reference_scene(GetParam());
    if (!scene_.has_value()) GTEST_SKIP() << "../shared/reference is not there: no ground truth to compare with";
    auto renderer = make_gl_renderer({.warm_all = false});
    ASSERT_TRUE(renderer.ok()) << renderer.status();
    renderer_ = *std::move(renderer);
  }

  std::vector<glm::vec3> render(Technique technique, diffusion::Quality quality, bool shadows) {
    auto scene = make_scene({scene_->mesh.positions_mm, scene_->mesh.triangles}, "marble", scene_->mesh.normals);
    scene->materials[0].coefficients = scene_->material;
    add_point_light(*scene, scene_->light_position_mm, scene_->light_intensity_w_sr);
    FrameRequest request;
    request.scene = scene;
    request.camera = {scene_->eye_mm, scene_->target_mm, scene_->up, scene_->fov_y_deg};
    request.width_px = request.height_px = scene_->size_px;
    request.settings.technique = technique;
    request.settings.quality = quality;
    request.settings.shadows = shadows;
    request.format = PixelFormat::kLinearFloat;
    const absl::StatusOr<Frame> frame = renderer_->render(request, std::atomic<bool>(false));
    EXPECT_TRUE(frame.ok()) << frame.status();
    const auto& values = std::get<base::ImageF>(frame->image).values;
    std::vector<glm::vec3> pixels(values.size() / 4);
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2]};
    return pixels;
  }

  void expect_within(const Bar& bar) {
    for (const bool shadows : {false, true}) {
      const glm::vec3 error = diaphane::testing::relative_rms_inside(
          render(bar.technique, bar.quality, shadows), diaphane::testing::load_reference_image(GetParam(), shadows),
          scene_->size_px);
      std::printf("%s %s: %.3f %.3f %.3f %%\n", GetParam().c_str(), shadows ? "shadowed" : "unshadowed", 100 * error.r,
                  100 * error.g, 100 * error.b);
      EXPECT_LE(std::max({error.r, error.g, error.b}), shadows ? bar.shadowed : bar.unshadowed);
    }
  }

  std::optional<diaphane::testing::ReferenceScene> scene_;
  std::unique_ptr<FrameRenderer> renderer_;
};

TEST_P(Truth, IntegralFine) { expect_within({Technique::kIntegral, diffusion::Quality::kFine, 0.010f, 0.015f}); }

TEST_P(Truth, IntegralNormal) { expect_within({Technique::kIntegral, diffusion::Quality::kNormal, 0.020f, 0.020f}); }

TEST_P(Truth, Reference) {
  if (std::getenv("DIAPHANE_SLOW_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: ./dev bench truth runs it";
  expect_within({Technique::kReference, diffusion::Quality::kNormal, 0.008f, 0.008f});
}

INSTANTIATE_TEST_SUITE_P(Scenes, Truth,
                         ::testing::Values("sphere_skin1_side", "slab_marble_back", "bunny20_marble_front"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace diaphane::render

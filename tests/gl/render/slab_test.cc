// Slab correction, from settings to pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"

namespace diaphane::render {
namespace {

using Pixels = std::vector<float>;

class Slab : public ::testing::Test {
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

  static FrameRequest request_of(std::shared_ptr<const scene::SceneSnapshot> scene) {
    FrameRequest request;
    request.scene = std::move(scene);
    request.camera.eye = {0, 0, 60};
    request.width_px = request.height_px = 48;
    request.format = PixelFormat::kLinearFloat;
    return request;
  }

  Pixels render(const FrameRequest& request) {
    const absl::StatusOr<Frame> frame = renderer_->render(request, std::atomic<bool>(false));
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (!frame.ok()) return {};
    stages_.clear();
    for (const StageTime& stage : frame->stages) stages_[stage.stage] = stage.ran;
    return std::get<base::ImageF>(frame->image).values;
  }

  std::map<std::string, bool> stages_;
  static inline FrameRenderer* renderer_ = nullptr;
};

std::shared_ptr<scene::SceneSnapshot> plate(float thickness_mm) {
  auto scene = make_scene(make_box({20, 20, thickness_mm}, 16), "marble");
  add_point_light(*scene, {5, 10, 60}, 4000);
  return scene;
}

float middle(const Pixels& pixels) { return pixels[4 * (24 * 48 + 24)]; }

TEST_F(Slab, DarkensAThinPlateAndLeavesAThickBodyAsItIs) {
  FrameRequest request = request_of(plate(0.5f));
  const float thin = middle(render(request));
  request.settings.slab_correction = true;
  const float thin_corrected = middle(render(request));
  request = request_of(plate(20));
  const float thick = middle(render(request));
  request.settings.slab_correction = true;
  const float thick_corrected = middle(render(request));
  EXPECT_LT(thin_corrected, 0.6f * thin);
  EXPECT_NEAR(thick_corrected / thick, 1, 0.02f);
}

TEST_F(Slab, RunsWhenAskedForSleepsWhenNothingChangedAndLeavesNoTrace) {
  FrameRequest request = request_of(plate(1));
  const Pixels plain = render(request);
  EXPECT_EQ(stages_.count("slab"), 0u);
  request.settings.slab_correction = true;
  const Pixels corrected = render(request);
  EXPECT_TRUE(stages_.at("slab"));
  EXPECT_NE(plain, corrected);
  EXPECT_EQ(render(request), corrected);
  EXPECT_FALSE(stages_.at("slab"));
  request.settings.slab_correction = false;
  EXPECT_EQ(render(request), plain);
}

TEST_F(Slab, IsTheReferencesToo) {
  FrameRequest request = request_of(plate(1));
  request.settings.slab_correction = true;
  request.settings.shadows = false;
  request.settings.quality = diffusion::Quality::kFine;
  const float integral = middle(render(request));
  request.settings.technique = Technique::kReference;
  const float reference = middle(render(request));
  EXPECT_NEAR(integral / reference, 1, 0.02f);
}

}  // namespace
}  // namespace diaphane::render

// The reference says how far it is, and stops when it is told to.
#include <gtest/gtest.h>

#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"

namespace diaphane::render {
namespace {

class ReferenceProgress : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = make_gl_renderer({.warm_all = false});
    ASSERT_TRUE(made.ok()) << made.status();
    renderer_ = *std::move(made);
    auto scene = make_scene(make_box({10, 10, 10}, 6), "marble");
    auto second = std::make_shared<scene::Mesh>(*scene->meshes[0]);
    second->name = "scenes/test/meshes/b";
    second->scene_from_mesh[3] = glm::vec4(14, 0, 0, 1);
    scene->meshes.push_back(second);
    request_.scene = scene;
    request_.camera = {{7, 0, 60}, {7, 0, 0}, {0, 1, 0}, 30};
    request_.width_px = 40;
    request_.height_px = 24;
    request_.settings.technique = Technique::kReference;
  }

  std::unique_ptr<FrameRenderer> renderer_;
  FrameRequest request_;
};

TEST_F(ReferenceProgress, GrowsOverAllMeshesToOne) {
  double last = 0;
  size_t calls = 0;
  bool grows = true;
  request_.progress = [&](double share) {
    grows = grows && share > last;
    last = share;
    ++calls;
  };
  ASSERT_TRUE(renderer_->render(request_, std::atomic<bool>(false)).ok());
  EXPECT_TRUE(grows);
  EXPECT_GT(calls, 50u);
  EXPECT_DOUBLE_EQ(last, 1);
}

TEST_F(ReferenceProgress, EndsWhereItIsCancelled) {
  std::atomic<bool> cancelled = false;
  double last = 0;
  request_.progress = [&](double share) {
    last = share;
    cancelled = true;
  };
  EXPECT_EQ(renderer_->render(request_, cancelled).status().code(), absl::StatusCode::kCancelled);
  // What other threads had begun may still be told.
  EXPECT_LT(last, 0.5);
  request_.progress = nullptr;
  EXPECT_TRUE(renderer_->render(request_, std::atomic<bool>(false)).ok());
}

}  // namespace
}  // namespace diaphane::render

// One renderer for all tests of a suite.
#pragma once

#include <gtest/gtest.h>

#include "render/gl_renderer.h"

namespace diaphane::render {

class SharedRenderer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto renderer = make_gl_renderer({.warm_all = false});
    ASSERT_TRUE(renderer.ok()) << renderer.status();
    renderer_ = renderer->release();
  }
  static void TearDownTestSuite() {
    delete renderer_;
    renderer_ = nullptr;
  }

  /// The values of a linear frame; none, and a failure, where it was refused.
  static std::vector<float> render(const FrameRequest& request) {
    auto frame = renderer_->render(request, std::atomic<bool>(false));
    if (!frame.ok()) {
      ADD_FAILURE() << frame.status();
      return {};
    }
    return std::get<base::ImageF>(frame->image).values;
  }

  static inline FrameRenderer* renderer_ = nullptr;
};

}  // namespace diaphane::render

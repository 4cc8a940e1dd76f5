// One renderer for all tests of a suite.
#pragma once

#include <gtest/gtest.h>

#include <string>

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

/// Every test with OpenGL's raster and with the native one.
class BothRasters : public testing::TestWithParam<Raster> {
 protected:
  void SetUp() override {
    if (renderer_ != nullptr && raster_ == GetParam()) return;
    // One at a time: a context is current to its thread.
    TearDownTestSuite();
    raster_ = GetParam();
    auto renderer = make_gl_renderer({.raster = raster_, .warm_all = false});
    ASSERT_TRUE(renderer.ok()) << renderer.status();
    renderer_ = renderer->release();
  }
  static void TearDownTestSuite() {
    delete renderer_;
    renderer_ = nullptr;
  }
  static bool native() { return raster_ == Raster::kNative; }

  static inline Raster raster_ = Raster::kAuto;
  static inline FrameRenderer* renderer_ = nullptr;
};

inline const auto kBothRasters = testing::Values(Raster::kGl, Raster::kNative);
inline std::string name_of_raster(const testing::TestParamInfo<Raster>& info) {
  return info.param == Raster::kGl ? "Gl" : "Native";
}

}  // namespace diaphane::render

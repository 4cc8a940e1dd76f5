// What a served frame costs the render thread once things go on as they did: counted, not timed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/server.h"
#include "diaphane/client.h"
#include "render/gl_renderer.h"
#include "tests/support/allocations.h"

namespace diaphane::e2e {
namespace {

constexpr int kRings = 24, kSegments = 32, kPoses = 8, kFrames = 300;

MeshData ball() {
  MeshData mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const float polar = std::numbers::pi_v<float> * float(ring) / kRings;
      const float azimuth = 2 * std::numbers::pi_v<float> * float(segment) / kSegments;
      mesh.positions.push_back(
          {std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth)});
    }
  }
  for (uint32_t ring = 0; ring < kRings; ++ring) {
    for (uint32_t segment = 0; segment < kSegments; ++segment) {
      const uint32_t next = (segment + 1) % kSegments, here = ring * kSegments;
      const uint32_t a = here + segment, b = here + next, c = a + kSegments, d = b + kSegments;
      if (ring > 0) mesh.triangles.insert(mesh.triangles.end(), {a, c, b});
      if (ring + 1 < kRings) mesh.triangles.insert(mesh.triangles.end(), {b, c, d});
    }
  }
  return mesh;
}

/// A stream of frames of a ball that deforms, from a server whose render thread's allocations are counted.
class SteadyStream : public ::testing::TestWithParam<ImageFormat> {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "a driver of OpenGL has threads that cannot be watched";
#endif
    auto server = app::Server::start({.listen = "127.0.0.1:0"}, [this] {
      auto renderer = render::make_gl_renderer({.warm_all = false});
      count_allocations_of_this_thread(&allocations_);
      return renderer;
    });
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    client_.emplace(*Client::connect(server_->address()));
    scene_.emplace(*client_->create_scene({.millimetres_per_unit = 10}));
    mesh_ = ball();
    body_ = *scene_->add_mesh(mesh_, {.material = *scene_->add_material({"marble"})});
    ASSERT_TRUE(scene_->add_light(PointLight{{2, 3, 4}, {4000, 4000, 4000}}).ok());
  }

  std::vector<Vec3> pose(int i) const {
    std::vector<Vec3> positions = mesh_.positions;
    for (Vec3& p : positions) p.x += 0.1f * std::sin(float(i % kPoses)) * p.y;
    return positions;
  }

  std::atomic<size_t> allocations_ = 0;
  std::unique_ptr<app::Server> server_;
  std::optional<Client> client_;
  std::optional<Scene> scene_;
  MeshData mesh_;
  MeshHandle body_;
};

TEST_P(SteadyStream, AllocatesNothingOnTheRenderThread) {
  StreamOptions options;
  options.view.camera.eye = {0, 0, 5};
  options.view.size = {160, 120};
  options.view.moving = GetParam();
  options.view.lossless_at_rest = false;
  FrameStream stream = scene_->stream(options);
  Deformer deformer = scene_->deform();
  size_t before = 0;
  for (int i = -40; i < kFrames; ++i) {
    if (i == 0) before = allocations_;
    ASSERT_TRUE(deformer.set_positions(body_, pose(i + 40)).ok());
    const auto revision = deformer.flush();
    ASSERT_TRUE(revision.ok()) << revision.status();
    uint64_t shown = 0;
    while (shown < *revision) {
      const auto frame = stream.next();
      ASSERT_TRUE(frame.ok()) << frame.status();
      shown = frame->frame.scene_revision;
    }
  }
  EXPECT_GT(before, 0u);
  EXPECT_EQ(allocations_ - before, 0u) << "in " << kFrames << " frames";
}

INSTANTIATE_TEST_SUITE_P(, SteadyStream, ::testing::Values(ImageFormat::kJpeg, ImageFormat::kWebp),
                         [](const auto& instance) { return instance.param == ImageFormat::kJpeg ? "Jpeg" : "Webp"; });

}  // namespace
}  // namespace diaphane::e2e

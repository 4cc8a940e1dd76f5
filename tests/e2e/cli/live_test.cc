// Live scenes through a real server and a real renderer.
#include <cmath>
#include <set>
#include <thread>

#include "diaphane/client.h"
#include "fixture.h"

namespace diaphane::testing_support {
namespace {

using testing::Contains;
using testing::IsSupersetOf;
using testing::Not;

class LiveTest : public CliWithServerTest {
 protected:
  LiveTest() : client_(*Client::connect(address_)), scene_(*client_.create_scene({.millimetres_per_unit = 10})) {
    material_ = *scene_.add_material({"marble"});
    light_ = *scene_.add_light(lamp(900));
    // A ball, so that all of the integral's stages have something to do.
    constexpr int kRings = 12, kSides = 24;
    for (int r = 0; r <= kRings; ++r) {
      for (int s = 0; s < kSides; ++s) {
        const float polar = 3.1416f * static_cast<float>(r) / kRings, around = 6.2832f * static_cast<float>(s) / kSides;
        mesh_.positions.push_back(
            {std::sin(polar) * std::cos(around), std::cos(polar), -std::sin(polar) * std::sin(around)});
      }
    }
    for (uint32_t r = 0; r < kRings; ++r) {
      for (uint32_t s = 0; s < kSides; ++s) {
        const uint32_t a = r * kSides + s, b = r * kSides + (s + 1) % kSides;
        mesh_.triangles.insert(mesh_.triangles.end(), {a, a + kSides, b, b, a + kSides, b + kSides});
      }
    }
    body_ = *scene_.add_mesh(mesh_, {.material = material_});
    view_.size = {64, 64};
    view_.camera.eye = {0, 0, 6};
    view_.camera.target = {0, 0, 0};
  }

  static Light lamp(float intensity) { return PointLight{{2, 3, 5}, {intensity, intensity, intensity}}; }

  static std::set<std::string> ran(const StreamedFrame& frame) {
    std::set<std::string> names;
    for (const StageTime& stage : frame.frame.stages) {
      if (stage.ran) names.insert(stage.stage);
    }
    return names;
  }

  Client client_;
  Scene scene_;
  MaterialHandle material_;
  LightHandle light_;
  MeshData mesh_;
  MeshHandle body_;
  StreamView view_;
};

TEST_F(LiveTest, AStreamedChangeIsShownNextAndWakesOnlyTheStagesThatItTouches) {
  view_.lossless_at_rest = false;
  FrameStream stream = scene_.stream({.view = view_});
  Deformer deformer = scene_.deform();
  const auto first = stream.next();
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_THAT(ran(*first), IsSupersetOf({"refine", "refit", "irradiance", "gather"}));
  std::string before = first->frame.image;
  const auto next = [&] {
    const auto frame = stream.next();
    EXPECT_TRUE(frame.ok()) << frame.status();
    EXPECT_FALSE(frame->frame.image == before);
    before = frame->frame.image;
    return ran(*frame);
  };

  // Redder marble, in which light goes as far: another mean free path would split triangles anew.
  ASSERT_TRUE(
      deformer.set_material(material_, {Coefficients{{0.002f, 0.02f, 0.03f}, {2.19f, 2.62f, 3.0f}, 1.5f}}).ok());
  const std::set<std::string> by_material = next();
  EXPECT_THAT(by_material, Contains("gather"));
  for (const char* asleep : {"place", "refine", "normals", "refit", "irradiance"})
    EXPECT_THAT(by_material, Not(Contains(asleep)));

  ASSERT_TRUE(deformer.set_light(light_, lamp(300)).ok());
  const std::set<std::string> by_light = next();
  EXPECT_THAT(by_light, IsSupersetOf({"irradiance", "gather"}));
  for (const char* asleep : {"place", "refine", "normals", "refit"}) EXPECT_THAT(by_light, Not(Contains(asleep)));

  std::vector<Vec3> positions = mesh_.positions;
  for (Vec3& p : positions) p.y *= 0.7f;
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  EXPECT_THAT(next(), IsSupersetOf({"place", "normals", "refit", "irradiance", "gather"}));

  view_.camera.eye = {3, 0, 5};
  stream.set_view(view_);
  const std::set<std::string> by_camera = next();
  for (const char* asleep : {"place", "refine", "normals", "refit", "irradiance", "gather"}) {
    EXPECT_THAT(by_camera, Not(Contains(asleep)));
  }
}

TEST_F(LiveTest, AtRestItSendsRenderFramesPngToTheByteAndThenNothing) {
  FrameStream stream = scene_.stream({.view = view_});
  Deformer deformer = scene_.deform();
  std::vector<Vec3> positions = mesh_.positions;
  for (int i = 0; i < 10; ++i) {
    for (Vec3& p : positions) p.x *= 1.01f;
    ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  }
  const uint64_t last = *deformer.flush();
  absl::StatusOr<StreamedFrame> frame = stream.next();
  while (frame.ok() && !(frame->at_rest && frame->frame.scene_revision == last)) frame = stream.next();
  ASSERT_TRUE(frame.ok()) << frame.status();
  const auto still = scene_.render({.camera = view_.camera, .size = view_.size, .settings = view_.settings});
  ASSERT_TRUE(still.ok()) << still.status();
  EXPECT_TRUE(frame->frame.image == still->image);
  // Whatever came now would be of a later view than this.
  std::thread closer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    stream.close();
  });
  EXPECT_TRUE(absl::IsCancelled(stream.next().status()));
  closer.join();
}

}  // namespace
}  // namespace diaphane::testing_support

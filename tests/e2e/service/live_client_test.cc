// The client library's live scenes against a server in this process.
#include <gmock/gmock.h>

#include <random>
#include <thread>

#include "diaphane/client.h"
#include "tests/e2e/service/test_server.h"

namespace diaphane::e2e {
namespace {

class LiveClientTest : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    connect();
    scene_.emplace(*client_->create_scene({}));
    material_ = *scene_->add_material({"marble"});
    for (int i = 0; i < 300; ++i) mesh_.positions.push_back({float(i % 20), float(i / 20), float(i % 7)});
    for (uint32_t i = 0; i + 2 < 300; ++i) mesh_.triangles.insert(mesh_.triangles.end(), {i, i + 1, i + 2});
    body_ = *scene_->add_mesh(mesh_, {.material = material_});
  }

  void connect() { client_.emplace(*Client::connect(server_->address())); }

  StreamOptions options() const {
    StreamOptions options;
    options.view.camera.eye = {0, 0, 60};
    options.view.size = {16, 8};
    return options;
  }

  std::vector<Vec3> server_positions() {
    std::vector<Vec3> positions;
    for (const glm::vec3& p : server_->scenes().mesh({"mesh", body_.name})->shape->positions) {
      positions.push_back({p.x, p.y, p.z});
    }
    return positions;
  }

  std::optional<Client> client_;
  std::optional<Scene> scene_;
  MaterialHandle material_;
  MeshData mesh_;
  MeshHandle body_;
};

TEST_F(LiveClientTest, EditsArriveInOrderAndFlushWaitsForThem) {
  Deformer deformer = scene_->deform();
  std::mt19937 random(3);
  std::vector<Vec3> here = mesh_.positions;
  for (int i = 0; i < 2000; ++i) {
    std::vector<uint32_t> indices;
    std::vector<Vec3> positions;
    for (int k = 0; k < 5; ++k) {
      indices.push_back(random() % here.size());
      positions.push_back({1.0f / (1 + random() % 9), float(random() % 99), -1.5f});
      here[indices.back()] = positions.back();
    }
    ASSERT_TRUE(deformer.set_positions(body_, indices, positions).ok());
  }
  const absl::StatusOr<uint64_t> revision = deformer.flush();
  ASSERT_TRUE(revision.ok()) << revision.status();
  EXPECT_EQ(*revision, scene_->describe()->scene.revision);
  EXPECT_EQ(server_positions(), here);
}

TEST_F(LiveClientTest, AFewPositionsArriveFromTheDeformersOwnMemory) {
  Deformer deformer = scene_->deform();
  const std::span<Vec3> buffer = deformer.positions_buffer(mesh_.positions.size());
  std::vector<Vec3> here = mesh_.positions;
  for (Vec3& p : here) p.x += 2;
  std::copy(here.begin(), here.end(), buffer.begin());
  ASSERT_TRUE(deformer.set_positions(body_, buffer).ok());
  ASSERT_TRUE(deformer.flush().ok());
  EXPECT_EQ(server_positions(), here);
  EXPECT_TRUE(deformer.positions_buffer(0).empty());
}

TEST_F(LiveClientTest, AGroupIsOneRevision) {
  Deformer deformer = scene_->deform();
  const uint64_t before = scene_->describe()->scene.revision;
  deformer.begin();
  ASSERT_TRUE(deformer.set_positions(body_, mesh_.positions).ok());
  ASSERT_TRUE(deformer.set_material(material_, {"skin1"}).ok());
  EXPECT_EQ(scene_->describe()->scene.revision, before);
  ASSERT_TRUE(deformer.commit().ok());
  EXPECT_EQ(*deformer.flush(), before + 1);
  EXPECT_EQ(std::get<std::string>(scene_->material(material_)->material.model), "skin1");
}

TEST_F(LiveClientTest, QuantizedPositionsAreWithinHalfAStep) {
  Deformer deformer = scene_->deform();
  ASSERT_TRUE(deformer.set_quantized_positions(body_, mesh_.positions, {0, 0, 0}, {20, 15, 7}).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const std::vector<Vec3> found = server_positions();
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].x, mesh_.positions[i].x, 0.51 * 20 / 65535);
    EXPECT_NEAR(found[i].y, mesh_.positions[i].y, 0.51 * 15 / 65535);
    EXPECT_NEAR(found[i].z, mesh_.positions[i].z, 0.51 * 7 / 65535);
  }
}

TEST_F(LiveClientTest, AFrameThatIsAskedForShowsWhatIsNewestThen) {
  StreamOptions on_demand = options();
  on_demand.view.lossless_at_rest = false;
  on_demand.frames_in_flight = 0;
  FrameStream stream = scene_->stream(on_demand);
  ASSERT_TRUE(stream.next().ok());
  Deformer deformer = scene_->deform();
  for (int round = 0; round < 5; ++round) {
    uint64_t newest = 0;
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(deformer.set_positions(body_, mesh_.positions).ok());
      newest = deformer.flush().value();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(stream.next()->frame.scene_revision, newest);
  }
  // None but those that were asked for were drawn.
  EXPECT_EQ(control_->started(), 6);
}

TEST_F(LiveClientTest, AViewerThatTakesNothingCostsOneRevisionHoweverManyPass) {
  FrameStream stream = scene_->stream(options());
  ASSERT_TRUE(stream.next().ok());
  Deformer deformer = scene_->deform();
  ASSERT_TRUE(deformer.set_positions(body_, mesh_.positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const uint64_t shape_bytes = mesh_.positions.size() * sizeof(Vec3);
  const uint64_t before = server_->scenes().mesh_bytes();
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(deformer.set_positions(body_, mesh_.positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  // The scene's own shape, and those of at most three frames that are on their way to the viewer.
  EXPECT_LE(server_->scenes().mesh_bytes(), before + 3 * shape_bytes);
}

TEST_F(LiveClientTest, MorphsByWeightsAndToTheSphere) {
  mesh_.morph_targets = {std::vector<Vec3>(mesh_.positions.size(), {0, 0, 2})};
  body_ = *scene_->add_mesh(mesh_, {.material = material_});
  Deformer deformer = scene_->deform();
  const std::vector<float> half{0.5f};
  ASSERT_TRUE(deformer.set_weights(body_, half).ok());
  ASSERT_TRUE(deformer.flush().ok());
  EXPECT_EQ(server_positions()[7].z, mesh_.positions[7].z + 1);
  ASSERT_TRUE(deformer.morph_to_sphere(body_, 0).ok());
  ASSERT_TRUE(deformer.flush().ok());
  EXPECT_EQ(server_positions(), mesh_.positions);
  mesh_.morph_targets[0].pop_back();
  EXPECT_TRUE(absl::IsInvalidArgument(scene_->add_mesh(mesh_, {.material = material_}).status()));
}

TEST_F(LiveClientTest, AWrongEditIsToldByTheCallThatMeetsItAndByAllAfter) {
  Deformer deformer = scene_->deform();
  const std::vector<uint32_t> indices = {300};
  const std::vector<Vec3> positions = {{0, 0, 0}};
  EXPECT_TRUE(deformer.set_positions(body_, indices, positions).ok());
  const absl::Status told = deformer.flush().status();
  EXPECT_EQ(told.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(told.message()), ::testing::HasSubstr("changes[0].positions.indices[0]"));
  EXPECT_EQ(deformer.set_positions(body_, mesh_.positions), told);
}

TEST_F(LiveClientTest, FramesFollowEditsFromAnotherThread) {
  FrameStream stream = scene_->stream(options());
  std::atomic<uint64_t> last{0};
  std::thread program([&] {
    Deformer deformer = scene_->deform();
    for (int i = 0; i < 100; ++i) {
      std::vector<Vec3> positions = mesh_.positions;
      for (Vec3& p : positions) p.z += static_cast<float>(i);
      EXPECT_TRUE(deformer.set_positions(body_, positions).ok());
    }
    last = deformer.flush().value();
  });
  uint64_t shown = 0;
  bool rested = false;
  while (last == 0 || shown < last || !rested) {
    const absl::StatusOr<StreamedFrame> frame = stream.next();
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_GE(frame->frame.scene_revision, shown);
    shown = frame->frame.scene_revision;
    rested = frame->at_rest;
    EXPECT_EQ(frame->frame.content_type, rested ? "image/png" : "image/jpeg");
  }
  program.join();
  EXPECT_EQ(shown, last);
}

TEST_F(LiveClientTest, AViewThatIsSetWhileFramesAreWaitedForIsShown) {
  FrameStream stream = scene_->stream(options());
  ASSERT_TRUE(stream.next().ok());
  uint64_t number = 0;
  std::thread viewer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    StreamView view = options().view;
    view.size = {32, 8};
    number = stream.set_view(view);
  });
  absl::StatusOr<StreamedFrame> frame = stream.next();
  while (frame.ok() && frame->view_number < 2) frame = stream.next();
  viewer.join();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->view_number, number);
  EXPECT_EQ(frame->frame.size.width_px, 32u);
}

TEST_F(LiveClientTest, CloseEndsAStreamThatWaits) {
  StreamOptions quiet = options();
  quiet.view.lossless_at_rest = false;
  FrameStream stream = scene_->stream(quiet);
  ASSERT_TRUE(stream.next().ok());
  std::thread closer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stream.close();
  });
  EXPECT_EQ(stream.next().status().code(), absl::StatusCode::kCancelled);
  closer.join();
}

TEST_F(LiveClientTest, ErrorsOfAViewComeOutOfNext) {
  StreamOptions wrong = options();
  wrong.view.size.width_px = 0;
  FrameStream stream = scene_->stream(wrong);
  const absl::Status status = stream.next().status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), ::testing::HasSubstr("size.width_px"));
}

}  // namespace
}  // namespace diaphane::e2e

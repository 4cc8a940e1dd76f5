// Edits whose positions follow them, by gRPC and by the client.
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <thread>

#include "diaphane/client.h"
#include "tests/e2e/service/edit_fixture.h"
#include "tests/support/relay.h"

namespace diaphane::e2e {
namespace {

class EditPayloadTest : public EditTest {
 protected:
  /// A change of the tetrahedron's positions that come later.
  v1::SceneChange announced(uint64_t payload_bytes) const {
    v1::SceneChange change;
    change.mutable_positions()->set_mesh(mesh_.name());
    change.mutable_positions()->mutable_float32();
    change.mutable_positions()->set_payload_bytes(payload_bytes);
    return change;
  }

  static bool send_payload(Stream& stream, const std::string& bytes) {
    v1::EditSceneRequest request;
    request.set_payload(bytes);
    return stream.Write(request);
  }

  /// Sends an edit and what follows it, which must be refused, and leave the scene as it is.
  void expect_payload_refused(const Changes& changes, const std::vector<std::string>& payloads,
                              const std::string& field) {
    const uint64_t before = get_scene(scene_).revision();
    grpc::ClientContext context;
    const auto stream = open(&context);
    send(*stream, 1, changes);
    for (const std::string& payload : payloads) send_payload(*stream, payload);
    const grpc::Status status = end(*stream);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_EQ(error_info(status).metadata().at("field"), field) << status.error_message();
    EXPECT_EQ(get_scene(scene_).revision(), before);
  }
};

TEST_F(EditPayloadTest, IsAppliedWithItsLastBytesAndNotBefore) {
  const std::vector<float> first = {1, 2, 3, 4, 5, 6}, second = {7, 8, 9, 10, 11, 12};
  v1::SceneChange quantized = announced(12);
  v1::VertexPositions& steps = *quantized.mutable_positions();
  steps.mutable_quantized()->mutable_highest()->set_x(65535);
  steps.add_indices(3);
  steps.add_indices(0);
  const uint64_t before = get_scene(scene_).revision();
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 5, {announced(48), moved({1}, {50, 60, 70}), quantized});
  send_payload(*stream, bytes_of(first));
  send_payload(*stream, bytes_of(second));
  send_payload(*stream, bytes_of(std::vector<uint16_t>{300, 0, 0}));
  EXPECT_EQ(get_scene(scene_).revision(), before);
  send_payload(*stream, bytes_of(std::vector<uint16_t>{200, 0, 0}));
  EXPECT_EQ(wait_for(*stream, 5), before + 1);
  EXPECT_THAT(server_positions(), ::testing::ElementsAre(glm::vec3(200, 0, 0), glm::vec3(50, 60, 70),
                                                         glm::vec3(7, 8, 9), glm::vec3(300, 0, 0)));
  send(*stream, 6, {moved({0}, {1, 1, 1})});
  EXPECT_EQ(wait_for(*stream, 6), before + 2);
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditPayloadTest, OfTheCodecMayBreakAnywhere) {
  const std::vector<float> positions = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string bytes = coded(positions, 4);
  v1::SceneChange change = announced(bytes.size());
  change.mutable_positions()->set_meshopt_count(4);
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {change});
  for (size_t at = 0; at < bytes.size(); at += 7) send_payload(*stream, bytes.substr(at, 7));
  wait_for(*stream, 1);
  EXPECT_EQ(server_positions()[3], glm::vec3(10, 11, 12));
  EXPECT_TRUE(end(*stream).ok());
}

TEST_F(EditPayloadTest, IsRefusedWhereItIsNotWhatWasSaid) {
  const std::string whole(48, '\0'), half(24, '\0');
  expect_payload_refused({announced(48)}, {half, whole}, "changes[0].payload");
  expect_payload_refused({announced(48)}, {half.substr(1)}, "changes[0].payload");
  expect_payload_refused({announced(48)}, {half, ""}, "changes[0].payload");
  expect_payload_refused({announced(24), announced(24)}, {whole}, "changes[0].payload");
  expect_payload_refused({announced(47)}, {}, "changes[0].positions.payload_bytes");
  expect_payload_refused({announced(24)}, {half}, "changes[0].positions");
  expect_payload_refused({announced(uint64_t{12} << 18)}, {std::string((1 << 20) + 12, '\0')}, "payload");
  v1::SceneChange both = moved({}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  both.mutable_positions()->set_payload_bytes(48);
  expect_payload_refused({both}, {whole}, "changes[0].positions.payload_bytes");
  v1::SceneChange indexed = announced(24);
  indexed.mutable_positions()->add_indices(1);
  expect_payload_refused({indexed}, {half}, "changes[0].positions.payload_bytes");
  expect_payload_refused({announced(48)}, {half, bytes_of(std::vector<float>{1, 2, 3, 4, NAN, 6})},
                         "changes[0].positions.float32[3].y");
}

TEST_F(EditPayloadTest, ComesBeforeAnythingElseAndOnlyWhereItWasAnnounced) {
  {
    grpc::ClientContext context;
    const auto stream = open(&context);
    send_payload(*stream, "123456789012");
    const grpc::Status status = end(*stream);
    EXPECT_EQ(error_info(status).metadata().at("field"), "part") << status.error_message();
  }
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {announced(48)});
  send_payload(*stream, std::string(12, '\0'));
  send(*stream, 2, {moved({0}, {1, 1, 1})});
  const grpc::Status status = end(*stream);
  EXPECT_EQ(error_info(status).metadata().at("field"), "part");
  EXPECT_THAT(status.error_message(), ::testing::HasSubstr("36 more bytes"));
}

TEST_F(EditPayloadTest, OfMoreThanThereIsMemoryForIsRefusedBeforeItIsAllocated) {
  grpc::ClientContext context;
  const auto stream = open(&context);
  send(*stream, 1, {announced(uint64_t{12} << 50)});
  EXPECT_EQ(end(*stream).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

/// More positions than fit a message, through a client.
class LargeEditTest : public ServiceTest {
 protected:
  static constexpr uint32_t kVertices = 450'000;

  void SetUp() override {
    ServiceTest::SetUp();
    relay_.emplace(server_->address());
    client_.emplace(*Client::connect(relay_->address()));
    scene_.emplace(*client_->create_scene({}));
    mesh_.positions = somewhere();
    for (uint32_t i = 0; i + 2 < kVertices; i += 30) mesh_.triangles.insert(mesh_.triangles.end(), {i, i + 1, i + 2});
    body_ = *scene_->add_mesh(mesh_, {.material = *scene_->add_material({"marble"})});
  }
  void TearDown() override {
    relay_->cut();
    ServiceTest::TearDown();
  }

  std::vector<Vec3> somewhere() {
    std::uniform_real_distribution<float> coordinate(-8, 8);
    std::vector<Vec3> positions(kVertices);
    for (Vec3& p : positions) p = {coordinate(random_), coordinate(random_), coordinate(random_)};
    return positions;
  }

  void expect_positions(const std::vector<Vec3>& expected, float within) {
    const auto mesh = server_->scenes().mesh({"mesh", body_.name});
    ASSERT_EQ(mesh->shape->positions.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
      const glm::vec3& found = mesh->shape->positions[i];
      ASSERT_NEAR(found.x, expected[i].x, within) << i;
      ASSERT_NEAR(found.y, expected[i].y, within) << i;
      ASSERT_NEAR(found.z, expected[i].z, within) << i;
    }
  }

  std::mt19937 random_{3};
  std::optional<testing::Relay> relay_;
  std::optional<Client> client_;
  std::optional<Scene> scene_;
  MeshData mesh_;
  MeshHandle body_;
};

TEST_F(LargeEditTest, ArrivesInEveryForm) {
  const Vec3 lowest{-8, -8, -8}, highest{8, 8, 8};
  constexpr float kStep = 16.f / 65535;
  for (const bool compress : {false, true}) {
    Deformer deformer = scene_->deform({.compress = compress});
    std::vector<Vec3> positions = somewhere();
    ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
    ASSERT_TRUE(deformer.flush().ok());
    expect_positions(positions, 0);
    positions = somewhere();
    ASSERT_TRUE(deformer.set_quantized_positions(body_, positions, lowest, highest).ok());
    ASSERT_TRUE(deformer.flush().ok());
    expect_positions(positions, 0.51f * kStep);
    // Two in one group: the later one counts.
    deformer.begin();
    ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
    positions = somewhere();
    ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
    ASSERT_TRUE(deformer.commit().ok());
    ASSERT_TRUE(deformer.flush().ok());
    expect_positions(positions, 0);
  }
}

size_t resident_mib() {
  std::ifstream statm("/proc/self/statm");
  size_t pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE)) >> 20;
}

TEST_F(LargeEditTest, KeepsOnlySoManyMegabytesOfThoseThatAreNotKnownToBeApplied) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what is freed";
#endif
  constexpr int kEdits = 31;  // of 5.4 MB: 160 MiB in all, of which 64 may be kept
  Deformer deformer = scene_->deform();
  const std::vector<Vec3> positions = somewhere();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const size_t before_mib = resident_mib();
  for (int edit = 0; edit < kEdits; ++edit) ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  EXPECT_LT(resident_mib(), before_mib + 120);
  EXPECT_TRUE(deformer.flush().ok());
}

TEST_F(LargeEditTest, SurvivesConnectionsThatBreakInTheMiddleOfIt) {
  Deformer deformer = scene_->deform();
  std::vector<Vec3> positions;
  for (int round = 0; round < 6; ++round) {
    std::atomic<bool> done = false;
    std::thread cutter([&] {
      for (int cut = 0; cut < 4 && !done; ++cut) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3 + 2 * cut));
        relay_->cut();
      }
    });
    absl::Status sent;
    for (int edit = 0; edit < 4 && sent.ok(); ++edit) {
      positions = somewhere();
      sent = deformer.set_positions(body_, positions);
    }
    const auto flushed = deformer.flush();
    done = true;
    cutter.join();
    ASSERT_TRUE(sent.ok()) << sent;
    ASSERT_TRUE(flushed.ok()) << flushed.status();
    expect_positions(positions, 0);
  }
}

}  // namespace
}  // namespace diaphane::e2e

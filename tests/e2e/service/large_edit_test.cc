// Edits of any size, by the client.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <thread>

#include "diaphane/client.h"
#include "tests/e2e/service/test_server.h"
#include "tests/support/relay.h"

namespace diaphane::e2e {
namespace {

/// More positions than fit a message; through memory shared with the server, and not.
class LargeEditTest : public ServiceTest, public ::testing::WithParamInterface<bool> {
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

TEST_P(LargeEditTest, ArrivesInEveryForm) {
  const Vec3 lowest{-8, -8, -8}, highest{8, 8, 8};
  constexpr float kStep = 16.f / 65535;
  for (const bool compress : {false, true}) {
    Deformer deformer = scene_->deform({.compress = compress, .share_memory = GetParam()});
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

TEST_P(LargeEditTest, KeepsOnlySoManyMegabytesOfThoseThatAreNotKnownToBeApplied) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what is freed";
#endif
  constexpr int kEdits = 31;  // of 5.4 MB: 160 MiB in all, of which 64 may be kept
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
  const std::vector<Vec3> positions = somewhere();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const size_t before_mib = resident_mib();
  for (int edit = 0; edit < kEdits; ++edit) ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  EXPECT_LT(resident_mib(), before_mib + 120);
  EXPECT_TRUE(deformer.flush().ok());
}

TEST_P(LargeEditTest, SurvivesConnectionsThatBreakInTheMiddleOfIt) {
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
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

TEST_P(LargeEditTest, TravelsOverTheConnectionOnlyWhereNoMemoryIsShared) {
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
  ASSERT_TRUE(deformer.set_positions(body_, somewhere()).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const uint64_t before = relay_->bytes_there();
  const std::vector<Vec3> positions = somewhere();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  expect_positions(positions, 0);
  const uint64_t travelled = relay_->bytes_there() - before;
  if (GetParam()) {
    EXPECT_LT(travelled, 1000u);
  } else {
    EXPECT_GT(travelled, kVertices * sizeof(Vec3));
  }
}

TEST_P(LargeEditTest, OfAGroupThatABreakDividesArrives) {
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
  ASSERT_TRUE(deformer.set_positions(body_, somewhere()).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const std::vector<Vec3> positions = somewhere();
  deformer.begin();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  relay_->cut();
  const std::vector<uint32_t> some = {3, 7};
  ASSERT_TRUE(deformer.set_positions(body_, some, std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}).ok());
  ASSERT_TRUE(deformer.commit().ok());
  ASSERT_TRUE(deformer.flush().ok());
  std::vector<Vec3> expected = positions;
  expected[3] = {1, 2, 3};
  expected[7] = {4, 5, 6};
  expect_positions(expected, 0);
}

TEST_P(LargeEditTest, ArrivesFromTheDeformersOwnMemory) {
  for (const bool compress : {false, true}) {
    Deformer deformer = scene_->deform({.compress = compress, .share_memory = GetParam()});
    for (int round = 0; round < 4; ++round) {
      const std::vector<Vec3> positions = somewhere();
      const std::span<Vec3> buffer = deformer.positions_buffer(kVertices);
      ASSERT_EQ(buffer.size(), kVertices);
      std::copy(positions.begin(), positions.end(), buffer.begin());
      if (round == 2) relay_->cut();
      ASSERT_TRUE(deformer.set_positions(body_, buffer).ok());
      ASSERT_TRUE(deformer.flush().ok());
      expect_positions(positions, 0);
    }
  }
}

TEST_P(LargeEditTest, OfAGroupArrivesFromTheDeformersOwnMemory) {
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
  ASSERT_TRUE(deformer.set_positions(body_, somewhere()).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const std::vector<Vec3> positions = somewhere();
  deformer.begin();
  const std::span<Vec3> buffer = deformer.positions_buffer(kVertices);
  std::copy(positions.begin(), positions.end(), buffer.begin());
  ASSERT_TRUE(deformer.set_positions(body_, buffer).ok());
  // Another buffer is other memory, given back unused.
  EXPECT_NE(deformer.positions_buffer(kVertices).data(), buffer.data());
  ASSERT_TRUE(deformer.commit().ok());
  ASSERT_TRUE(deformer.flush().ok());
  expect_positions(positions, 0);
}

TEST_P(LargeEditTest, SomeOfABufferOrMemoryBesideItIsSentAsAnyOther) {
  Deformer deformer = scene_->deform({.share_memory = GetParam()});
  std::vector<Vec3> positions = somewhere();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  const std::span<Vec3> buffer = deformer.positions_buffer(kVertices);
  buffer[0] = {1, 2, 3};
  buffer[1] = {4, 5, 6};
  ASSERT_TRUE(deformer.set_positions(body_, std::vector<uint32_t>{5, 9}, buffer.first(2)).ok());
  ASSERT_TRUE(deformer.flush().ok());
  positions[5] = {1, 2, 3};
  positions[9] = {4, 5, 6};
  expect_positions(positions, 0);
  positions = somewhere();
  ASSERT_TRUE(deformer.set_positions(body_, positions).ok());
  ASSERT_TRUE(deformer.flush().ok());
  expect_positions(positions, 0);
}

INSTANTIATE_TEST_SUITE_P(ThroughSharedMemory, LargeEditTest, ::testing::Bool());

}  // namespace
}  // namespace diaphane::e2e

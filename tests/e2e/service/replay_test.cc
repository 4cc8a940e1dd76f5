// Edits over connections that break: what the client sends again, and what that makes of a scene.
#include <gmock/gmock.h>

#include <random>
#include <thread>

#include "diaphane/client.h"
#include "geometry/morph.h"
#include "tests/e2e/service/test_server.h"
#include "tests/support/relay.h"

namespace diaphane::e2e {
namespace {

constexpr int kVertices = 700;
const Vec3 kLowest{-8, -8, -8}, kHighest{8, 8, 8};
constexpr float kHalfStep = 0.5f * 16 / 65535;

glm::vec3 glm_of(const Vec3& v) { return {v.x, v.y, v.z}; }

class ReplayTest : public ServiceTest, public ::testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    relay_.emplace(server_->address());
    client_.emplace(*Client::connect(relay_->address()));
    scene_.emplace(*client_->create_scene({}));
    // Bent enough that no vertex lies in the middle; eighths, so that sums are exact.
    for (int i = 0; i < kVertices; ++i) {
      mesh_.positions.push_back({0.125f * float(i % 27), 0.125f * float(i / 27), 0.125f * float(i * i % 31)});
    }
    for (uint32_t i = 0; i + 2 < kVertices; ++i) mesh_.triangles.insert(mesh_.triangles.end(), {i, i + 1, i + 2});
    for (int target = 0; target < 2; ++target) {
      std::vector<Vec3>& displacements = mesh_.morph_targets.emplace_back(kVertices);
      for (Vec3& d : displacements) d = {0.25f * float(random_() % 5), 0, target == 0 ? 0.5f : -0.25f};
    }
    body_ = *scene_->add_mesh(mesh_, {.material = *scene_->add_material({"marble"})});
    for (const Vec3& p : mesh_.positions) rest_.push_back(glm_of(p));
    here_ = rest_;
    within_.assign(kVertices, 0);
  }
  void TearDown() override {
    relay_->cut();
    ServiceTest::TearDown();
  }

  Vec3 somewhere() {
    std::uniform_real_distribution<float> coordinate(-8, 8);
    return {coordinate(random_), coordinate(random_), coordinate(random_)};
  }

  /// What becomes of the mesh by `edit`, which is sent, is noted here too.
  void send_one(Deformer& deformer, int edit) {
    std::vector<uint32_t> indices;
    std::vector<Vec3> to;
    for (uint32_t i = 0, count = 1 + random_() % 40; i < count; ++i) {
      indices.push_back(random_() % kVertices);
      to.push_back(somewhere());
    }
    switch (edit % 8) {
      case 0: {
        const std::vector<float> weights{0.5f * float(random_() % 4), -1};
        ASSERT_TRUE(deformer.set_weights(body_, weights).ok());
        for (size_t v = 0; v < kVertices; ++v) {
          here_[v] = rest_[v] + weights[0] * glm_of(mesh_.morph_targets[0][v]) - glm_of(mesh_.morph_targets[1][v]);
        }
        within_.assign(kVertices, 0);
        return;
      }
      case 3: {
        const float amount = 0.25f * float(random_() % 5);
        ASSERT_TRUE(deformer.morph_to_sphere(body_, amount).ok());
        here_ = geometry::morphed_to_sphere(rest_, amount);
        within_.assign(kVertices, 0);
        return;
      }
      case 5: {
        std::vector<Vec3> displacements(kVertices);
        for (size_t v = 0; v < kVertices; ++v) {
          displacements[v] = somewhere();
          here_[v] = rest_[v] + glm_of(displacements[v]);
        }
        ASSERT_TRUE(deformer.set_quantized_displacements(body_, displacements, kLowest, kHighest).ok());
        // And the sum's rounding.
        within_.assign(kVertices, kHalfStep + 1e-6f);
        return;
      }
      case 2:
      case 6:
        ASSERT_TRUE(deformer.set_quantized_positions(body_, indices, to, kLowest, kHighest).ok());
        break;
      default:
        ASSERT_TRUE(deformer.set_positions(body_, indices, to).ok());
    }
    for (size_t i = 0; i < indices.size(); ++i) {
      here_[indices[i]] = glm_of(to[i]);
      within_[indices[i]] = edit % 4 == 2 ? kHalfStep + 1e-6f : 0;
    }
  }

  scene::Mesh server_mesh() { return *server_->scenes().mesh({"mesh", body_.name}); }

  void expect_both_sides_agree() {
    const std::vector<glm::vec3>& found = server_mesh().shape->positions;
    for (size_t v = 0; v < kVertices; ++v) {
      for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(found[v][axis], here_[v][axis], within_[v]) << v;
    }
  }

  std::mt19937 random_{17};
  std::optional<testing::Relay> relay_;
  std::optional<Client> client_;
  std::optional<Scene> scene_;
  MeshData mesh_;
  MeshHandle body_;
  std::vector<glm::vec3> rest_, here_;
  std::vector<float> within_;  // how near the server's are, by vertex
};

TEST_P(ReplayTest, EditsThatWereAppliedUnheardAreSentAgainAndEndInTheSameScene) {
  constexpr int kRounds = 9, kUnheard = 11, kHeard = 60;
  Deformer deformer = scene_->deform({.compress = GetParam()});
  const uint64_t first = server_mesh().positions_revision;
  int edit = 0;
  for (int round = 0; round < kRounds; ++round) {
    ASSERT_TRUE(deformer.flush().ok());
    relay_->mute();
    const uint64_t before = server_mesh().positions_revision;
    for (int i = 0; i < kUnheard; ++i) send_one(deformer, edit++);
    while (server_mesh().positions_revision < before + kUnheard) std::this_thread::yield();
    relay_->cut();
    for (int i = 0; i < kHeard; ++i) send_one(deformer, edit++);
  }
  const absl::StatusOr<uint64_t> last = deformer.flush();
  ASSERT_TRUE(last.ok()) << last.status();
  expect_both_sides_agree();
  // Those that nobody heard of were applied twice.
  EXPECT_EQ(*last, first + static_cast<uint64_t>(edit + kRounds * kUnheard));
}

TEST_P(ReplayTest, EditsOverConnectionsThatBreakAnywhereEndInTheSameScene) {
  Deformer deformer = scene_->deform({.compress = GetParam()});
  const uint64_t first = server_mesh().positions_revision;
  constexpr int kEdits = 3'000;
  int until_cut = 100;
  for (int edit = 0; edit < kEdits; ++edit) {
    send_one(deformer, edit);
    if (--until_cut > 0) continue;
    relay_->cut();
    until_cut = 50 + static_cast<int>(random_() % 200);
  }
  const absl::StatusOr<uint64_t> last = deformer.flush();
  ASSERT_TRUE(last.ok()) << last.status();
  expect_both_sides_agree();
  EXPECT_GE(*last, first + kEdits);
}

INSTANTIATE_TEST_SUITE_P(Compressed, ReplayTest, ::testing::Bool());

}  // namespace
}  // namespace diaphane::e2e

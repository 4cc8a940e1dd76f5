// Edits of the SceneStore: SceneStore::apply().
#include <gmock/gmock.h>

#include <thread>

#include "base/status.h"
#include "scene/mesh_memory.h"
#include "tests/unit/scene/meshes.h"

namespace diaphane::scene {
namespace {

using ::testing::ElementsAre;

class EditsTest : public ::testing::Test {
 protected:
  void SetUp() override { create({}); }

  void create(const SceneLimits& limits) {
    store_.emplace(limits);
    scene_ = (*store_->create_scene({}))->name;
    material_ = store_->create_material({"parent", scene_}, {optics::PresetName{"marble"}})->value.name;
    mesh_ = add_triangle(*store_, scene_, material_).value.name;
  }

  absl::StatusOr<uint64_t> apply(const std::vector<SceneChange>& changes) {
    return store_->apply({"scene", scene_}, changes);
  }
  std::vector<glm::vec3> positions(const std::string& mesh) const {
    return store_->mesh({"mesh", mesh})->shape->positions;
  }
  SceneChange moved(std::vector<uint32_t> indices, std::vector<glm::vec3> to) const {
    return {mesh_, PositionsPatch{std::move(indices), std::move(to)}};
  }

  std::optional<SceneStore> store_;
  std::string scene_, material_, mesh_;
};

TEST_F(EditsTest, ChangesOfOneMeshFollowEachOther) {
  const std::string other = add_triangle(*store_, scene_, material_).value.name;
  const glm::vec3 a(1), b(2), c(3), d(4);
  SceneChange elsewhere = moved({2}, {d});
  elsewhere.name = other;
  const uint64_t before = (*store_->scene({"name", scene_}))->revision;
  const uint64_t bytes = store_->mesh_bytes();
  EXPECT_EQ(*apply({moved({0}, {a}), moved({}, {b, b, b}), elsewhere, moved({1}, {c}), moved({1, 2, 1}, {b, d, a})}),
            before + 1);
  EXPECT_THAT(positions(mesh_), ElementsAre(b, a, d));
  EXPECT_THAT(positions(other), ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), d));
  EXPECT_EQ(store_->mesh_bytes(), bytes);
}

TEST_F(EditsTest, TellsTheFirstChangeThatCannotBe) {
  const SceneChange unknown{scene_ + "/materials/99", MaterialPatch{}};
  const SceneChange beyond = moved({3}, {glm::vec3(0)});
  const SceneChange far{mesh_, PositionsPatch{{}, std::vector<glm::vec3>(3, glm::vec3(0, 2e18f, 0)), true}};
  const auto field = [&](const std::vector<SceneChange>& changes) {
    return base::field_violation(apply(changes).status()).field;
  };
  EXPECT_EQ(field({unknown, beyond}), "changes[0].material.name");
  EXPECT_EQ(field({beyond, unknown}), "changes[0].positions.indices[0]");
  EXPECT_EQ(field({moved({0}, {glm::vec3(5)}), far, unknown}), "changes[1].positions");
  SceneChange far_elsewhere = far;
  far_elsewhere.name = add_triangle(*store_, scene_, material_).value.name;
  EXPECT_EQ(field({moved({0}, {glm::vec3(5)}), far_elsewhere, far, beyond}), "changes[1].positions");
  EXPECT_EQ(
      apply({far}).status().message(),
      "changes[0].positions: must be what leads to positions that are finite, within ±1e18, got one at (0, 2e+18, "
      "0)");
  EXPECT_EQ(positions(mesh_)[0], glm::vec3(0));
}

TEST_F(EditsTest, TakesTheMemoryOfShapesFromTheBudget) {
  // What the mesh takes once it is there; its upload needs more, for a while.
  const uint64_t kept = store_->mesh_bytes();
  const uint64_t most = kept + upload_bytes(kTriangleCounts);
  create({.max_mesh_bytes = most});
  std::vector<SnapshotPtr> frames_in_flight;
  absl::Status status;
  while (status.ok()) {
    frames_in_flight.push_back(*store_->scene({"name", scene_}));
    status = apply({moved({0}, {glm::vec3(float(frames_in_flight.size()))})}).status();
    ASSERT_LE(store_->mesh_bytes(), most);
  }
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(frames_in_flight.size(), 1 + upload_bytes(kTriangleCounts) / shape_bytes(kTriangleCounts));
  frames_in_flight.clear();
  EXPECT_TRUE(apply({moved({0}, {glm::vec3(1)})}).ok());
}

TEST_F(EditsTest, NoneIsLostAmongManyThreads) {
  constexpr int kThreads = 3, kEdits = 2'000;
  const uint64_t before = (*store_->scene({"name", scene_}))->revision;
  std::vector<std::thread> threads;
  for (uint32_t vertex = 0; vertex < kThreads; ++vertex) {
    threads.emplace_back([&, vertex] {
      for (int i = 1; i <= kEdits; ++i) {
        ASSERT_TRUE(apply({moved({vertex}, {glm::vec3(vertex, i, 0)})}).ok());
        ASSERT_EQ(positions(mesh_)[vertex].y, i);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(positions(mesh_), ElementsAre(glm::vec3(0, kEdits, 0), glm::vec3(1, kEdits, 0), glm::vec3(2, kEdits, 0)));
  EXPECT_EQ((*store_->scene({"name", scene_}))->revision, before + kThreads * kEdits);
}

}  // namespace
}  // namespace diaphane::scene

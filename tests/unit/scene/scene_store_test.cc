#include "scene/scene_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "base/status.h"
#include "tests/unit/scene/meshes.h"

namespace diaphane::scene {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::string message_of(const absl::Status& status) { return std::string(status.message()); }

class SceneStoreTest : public ::testing::Test {
 protected:
  std::string new_scene() { return (*store_.create_scene({"bust", 10.0}))->name; }
  std::string new_material(const std::string& scene) {
    return store_.create_material({"parent", scene}, {optics::PresetName{"marble"}})->value.name;
  }

  SceneStore store_{{.max_scenes = 5}};
};

TEST_F(SceneStoreTest, NamesScenesBy128BitsThatDiffer) {
  const std::string a = new_scene();
  const std::string b = new_scene();
  EXPECT_THAT(a, MatchesRegex("scenes/[0-9a-f]{32}"));
  EXPECT_NE(a, b);
}

TEST_F(SceneStoreTest, RaisesTheRevisionWithEveryMutation) {
  const std::string scene = new_scene();
  EXPECT_EQ((*store_.scene({"name", scene}))->revision, 1u);
  EXPECT_EQ(store_.create_material({"parent", scene}, {optics::PresetName{"marble"}})->scene_revision, 2u);
  const auto light = *store_.create_light({"parent", scene}, {});
  EXPECT_EQ(light.scene_revision, 3u);
  EXPECT_EQ(store_.update_light({"light.name", light.value.name}, {})->scene_revision, 4u);
  EXPECT_EQ(*store_.delete_light({"name", light.value.name}), 5u);
  EXPECT_EQ((*store_.update_scene({"scene.name", scene}, {}))->revision, 6u);
}

TEST_F(SceneStoreTest, LeavesASnapshotAsItWas) {
  const std::string scene = new_scene();
  const SnapshotPtr before = *store_.scene({"name", scene});
  new_material(scene);
  EXPECT_EQ(before->revision, 1u);
  EXPECT_TRUE(before->materials.empty());
  EXPECT_EQ((*store_.scene({"name", scene}))->materials.size(), 1u);
}

TEST_F(SceneStoreTest, PatchesOnlyWhatIsGiven) {
  const std::string scene = new_scene();
  const SnapshotPtr renamed = *store_.update_scene({"scene.name", scene}, {"head", std::nullopt});
  EXPECT_EQ(renamed->display_name, "head");
  EXPECT_EQ(renamed->millimetres_per_unit, 10);
  const auto light = *store_.create_light({"parent", scene}, PointLight{{1, 2, 3}, {4, 5, 6}});
  const auto moved = *store_.update_light({"light.name", light.value.name}, {glm::vec3(7), std::nullopt});
  EXPECT_EQ(std::get<PointLight>(moved.value.kind).position, glm::vec3(7));
  EXPECT_EQ(std::get<PointLight>(moved.value.kind).intensity_w_sr, glm::vec3(4, 5, 6));
}

TEST_F(SceneStoreTest, DoesNotReuseTheNameOfADeletedChild) {
  const std::string scene = new_scene();
  const std::string first = new_material(scene);
  ASSERT_TRUE(store_.delete_material({"name", first}).ok());
  EXPECT_NE(new_material(scene), first);
}

TEST_F(SceneStoreTest, PagesThroughScenesWhileSomeGo) {
  std::vector<std::string> names;
  for (int i = 0; i < 5; ++i) names.push_back(new_scene());
  const ScenePage first = *store_.scenes(2, {"page_token", ""});
  ASSERT_EQ(first.scenes.size(), 2u);
  EXPECT_EQ(first.scenes[1]->name, names[1]);
  ASSERT_TRUE(store_.delete_scene({"name", names[1]}).ok());
  const ScenePage second = *store_.scenes(2, {"page_token", first.next_page_token});
  ASSERT_EQ(second.scenes.size(), 2u);
  EXPECT_EQ(second.scenes[0]->name, names[2]);
  const ScenePage last = *store_.scenes(2, {"page_token", second.next_page_token});
  ASSERT_EQ(last.scenes.size(), 1u);
  EXPECT_EQ(last.next_page_token, "");
}

TEST_F(SceneStoreTest, RefusesAPageTokenThatIsNotItsOwn) {
  EXPECT_EQ(store_.scenes(2, {"page_token", "12x"}).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(SceneStoreTest, RefusesOneSceneTooMany) {
  for (int i = 0; i < 5; ++i) new_scene();
  const absl::Status full = store_.create_scene({}).status();
  EXPECT_EQ(full.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(full.message(), "scenes: must be at most 5, got 6");
}

TEST_F(SceneStoreTest, TellsAnUnknownNameFromOneOfTheWrongForm) {
  const std::string scene = new_scene();
  EXPECT_EQ(store_.scene({"name", "scenes/0"}).status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(store_.scene({"name", "rooms/0"}).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(store_.scene({"name", scene + "/"}).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(store_.light({"name", scene + "/lights/9"}).status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(store_.light({"name", scene + "/materials/9"}).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(store_.light({"name", "scenes/0/lights/9"}).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(SceneStoreTest, KeepsAMaterialThatAMeshUses) {
  const std::string scene = new_scene();
  const std::string material = new_material(scene);
  const auto mesh = add_triangle(store_, scene, material);
  const absl::Status refused = store_.delete_material({"name", material}).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(message_of(refused), HasSubstr(mesh.value.name));
  ASSERT_TRUE(store_.delete_mesh({"name", mesh.value.name}).ok());
  EXPECT_TRUE(store_.delete_material({"name", material}).ok());
}

TEST_F(SceneStoreTest, RefusesAMaterialOfAnotherScene) {
  const std::string scene = new_scene();
  const std::string foreign = new_material(new_scene());
  const absl::Status refused =
      store_.reserve_mesh({"parent", scene}, {"mesh.material", foreign}, kTriangleCounts).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(base::field_violation(refused).field, "mesh.material");
  EXPECT_EQ(store_.mesh_bytes(), 0u);
}

TEST_F(SceneStoreTest, AppliesNothingOfARefusedMutation) {
  const std::string scene = new_scene();
  const std::string material = new_material(scene);
  const auto mesh = add_triangle(store_, scene, material);
  const MeshPatch patch{scene + "/materials/77", glm::mat4(2)};
  EXPECT_EQ(store_.update_mesh({"mesh.name", mesh.value.name}, patch).status().code(), absl::StatusCode::kNotFound);
  const SnapshotPtr after = *store_.scene({"name", scene});
  EXPECT_EQ(after->revision, mesh.scene_revision);
  EXPECT_EQ(after->meshes[0]->scene_from_mesh, glm::mat4(1));
}

TEST_F(SceneStoreTest, SharesTheTopologyWhenPositionsChange) {
  const std::string scene = new_scene();
  const auto mesh = add_triangle(store_, scene, new_material(scene));
  auto reservation = *store_.reserve_positions({"name", mesh.value.name}, 3, false);
  const auto shape =
      std::make_shared<const geometry::MeshShape>(geometry::MeshShape{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {}});
  const auto moved = *store_.replace_positions({"name", mesh.value.name}, shape, std::move(reservation));
  EXPECT_EQ(moved.value.topology, mesh.value.topology);
  EXPECT_EQ(moved.value.shape->positions[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(moved.value.positions_revision, moved.scene_revision);
  EXPECT_GT(moved.scene_revision, mesh.scene_revision);
}

TEST_F(SceneStoreTest, RefusesPositionsOfAnotherCount) {
  const std::string scene = new_scene();
  const auto mesh = add_triangle(store_, scene, new_material(scene));
  const absl::Status refused = store_.reserve_positions({"name", mesh.value.name}, 4, false).status();
  EXPECT_EQ(refused.message(), "vertex_count: must be the mesh's 3, got 4");
}

TEST_F(SceneStoreTest, CountsMutationsFromManyThreads) {
  const std::string scene = new_scene();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 50; ++i) ASSERT_TRUE(store_.update_scene({"scene.name", scene}, {}).ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ((*store_.scene({"name", scene}))->revision, 201u);
}

}  // namespace
}  // namespace diaphane::scene

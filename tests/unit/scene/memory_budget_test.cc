#include "scene/memory_budget.h"

#include <gtest/gtest.h>

#include "scene/mesh_memory.h"
#include "tests/unit/scene/meshes.h"

namespace diaphane::scene {
namespace {

TEST(MemoryBudget, RefusesWhatWouldPassTheLimit) {
  MemoryBudget budget(100);
  const auto first = budget.reserve(60);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(budget.reserve(41).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(budget.reserve(~uint64_t{0}).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_TRUE(budget.reserve(40).ok());
}

TEST(MemoryBudget, GetsBackWhatAReservationLeaves) {
  MemoryBudget budget(100);
  {
    Reservation whole = *budget.reserve(100);
    Reservation part = whole.split(30);
    EXPECT_EQ(budget.used_bytes(), 100u);
    whole.shrink_to(10);
    EXPECT_EQ(budget.used_bytes(), 40u);
    whole = std::move(part);
    EXPECT_EQ(budget.used_bytes(), 30u);
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
}

TEST(MeshMemory, CountsForAsLongAsASnapshotKeepsTheMesh) {
  SceneStore store({});
  const std::string scene = (*store.create_scene({}))->name;
  const std::string material = store.create_material({"parent", scene}, {optics::PresetName{"marble"}})->value.name;
  add_triangle(store, scene, material);
  EXPECT_EQ(store.mesh_bytes(), topology_bytes(kTriangleCounts) + shape_bytes(kTriangleCounts));
  SnapshotPtr kept = *store.scene({"name", scene});
  ASSERT_TRUE(store.delete_scene({"name", scene}).ok());
  EXPECT_GT(store.mesh_bytes(), 0u);
  kept.reset();
  EXPECT_EQ(store.mesh_bytes(), 0u);
}

TEST(MeshMemory, IsReservedForAnUploadAndGivenBack) {
  SceneLimits limits;
  limits.max_mesh_bytes = upload_bytes(kTriangleCounts);
  SceneStore store(limits);
  const std::string scene = (*store.create_scene({}))->name;
  const std::string material = store.create_material({"parent", scene}, {optics::PresetName{"marble"}})->value.name;
  const auto reserve = [&] {
    return store.reserve_mesh({"parent", scene}, {"mesh.material", material}, kTriangleCounts);
  };
  {
    const auto first = reserve();
    ASSERT_TRUE(first.ok());
    EXPECT_EQ(reserve().status().code(), absl::StatusCode::kResourceExhausted);
  }
  EXPECT_TRUE(reserve().ok());
}

}  // namespace
}  // namespace diaphane::scene

// Where nodes, instances and skins of glTF put their meshes.
#include <gmock/gmock.h>

#include <limits>

#include "tests/unit/readers/gltf_builder.h"

namespace diaphane::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// Where `mesh` puts its vertex in the scene.
Vec3 in_scene(const MeshData& mesh, size_t vertex) {
  const auto& m = mesh.scene_from_mesh;
  const Vec3& p = mesh.positions.at(vertex);
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

TEST(GltfPose, TakesTheDefaultSceneOfSeveral) {
  Gltf gltf;
  gltf["nodes"] = {{{"mesh", 0}, {"name", "first"}}, {{"mesh", 0}, {"name", "second"}}};
  gltf["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(gltf.read()->meshes.at(0).name, "first");
  gltf["scene"] = 1;
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(1));
  EXPECT_EQ(file->meshes[0].name, "second");
}

TEST(GltfPose, KeepsTheTransformOfEachNodeAndANegativeScale) {
  Gltf gltf;
  gltf["nodes"] = {{{"mesh", 0}, {"scale", {-2, 1, 1}}, {"children", {1}}}, {{"mesh", 0}, {"translation", {1, 2, 3}}}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(2));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_EQ(in_scene(file->meshes[0], 1), (Vec3{-2, 0, 0}));
  EXPECT_EQ(in_scene(file->meshes[1], 1), (Vec3{-4, 2, 3}));
}

TEST(GltfPose, LeavesOutWhatATransformFlattens) {
  Gltf gltf;
  gltf["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {1, 0, 1}}}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes, SizeIs(1));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 primitives of no volume (scale 0)"));
}

// A node that places its triangle by EXT_mesh_gpu_instancing: shifted, and turned a half round z and doubled.
Gltf instanced_gltf() {
  Gltf gltf;
  const int translation = gltf.add_accessor(Gltf::positions({5, 0, 0, 0, 7, 0}), kFloat, "VEC3", 2);
  const std::string half_turn = raw(int16_t{0}) + raw(int16_t{0}) + raw(int16_t{32767}) + raw(int16_t{0});
  const std::string none = raw(int16_t{0}) + raw(int16_t{0}) + raw(int16_t{0}) + raw(int16_t{32767});
  const int rotation = gltf.add_accessor(none + half_turn, kShort, "VEC4", 2, true);
  const int scale = gltf.add_accessor(Gltf::positions({1, 1, 1, 2, 2, 2}), kFloat, "VEC3", 2);
  gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  gltf["nodes"][0]["translation"] = {0, 0, 1};
  gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 99}};
  return gltf;
}

TEST(GltfPose, PlacesAMeshAtEachOfItsInstances) {
  const auto file = instanced_gltf().read();
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(2));
  EXPECT_EQ(in_scene(file->meshes[0], 1), (Vec3{6, 0, 1}));
  const Vec3 turned = in_scene(file->meshes[1], 1);
  EXPECT_NEAR(turned.x, -2, 1e-5);
  EXPECT_NEAR(turned.y, 7, 1e-5);
  EXPECT_NEAR(turned.z, 1, 1e-5);
}

TEST(GltfPose, RefusesInstancesThatDoNotAddUp) {
  ReadLimits limits;
  limits.max_nodes = 1;
  EXPECT_THAT(message(instanced_gltf().read(limits)), HasSubstr("2 instances, must be at most 1"));
  Gltf counts = instanced_gltf();
  counts.accessor(3)["count"] = 1;
  EXPECT_THAT(message(counts.read()), HasSubstr("1 elements, accessor 3, must be 2"));
  Gltf type = instanced_gltf();
  type.accessor(2)["componentType"] = kShort;
  EXPECT_THAT(message(type.read()), HasSubstr("accessor 2, must be VEC3 of floats"));
  Gltf nothing = instanced_gltf();
  nothing["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 77;
  EXPECT_THAT(message(nothing.read()), HasSubstr("accessor 77, there are 5"));
  Gltf wrong = instanced_gltf();
  wrong["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = 3;
  EXPECT_THAT(message(wrong.read()), HasSubstr("attributes of the wrong type or missing, nodes 0, must be an object"));
  Gltf length = instanced_gltf();
  length["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
      length.add_accessor(std::string(16, '\0'), kShort, "VEC4", 2, true);
  EXPECT_THAT(message(length.read()), HasSubstr("rotation 0 of length 0, node 0"));
}

std::string matrix_at(float x, float y, float z) {
  return Gltf::positions({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1});
}

std::string joints(const std::vector<int>& values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

// The triangle hangs on two joints, nodes 1 and 2: its first vertex on the one, its second on the other, its third on
// both. The joints stand where the bind pose has them, but `moved` of the second.
Gltf skinned_gltf(const json& moved = {0, 0, 3}) {
  Gltf gltf;
  gltf["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {50, 0, 0}}},
                   {{"translation", {1, 0, 0}}, {"children", {2}}},
                   {{"translation", moved}}};
  const int bind = gltf.add_accessor(matrix_at(-1, 0, 0) + matrix_at(-1, 0, 0), kFloat, "MAT4", 2);
  gltf["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
  gltf.primitive()["attributes"]["JOINTS_0"] =
      gltf.add_accessor(joints({0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0}), kUnsignedByte, "VEC4", 3);
  gltf.primitive()["attributes"]["WEIGHTS_0"] =
      gltf.add_accessor(Gltf::positions({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}), kFloat, "VEC4", 3);
  gltf.primitive()["attributes"]["NORMAL"] =
      gltf.add_accessor(Gltf::positions({0, 0, 1, 0, 0, 1, 0, 0, 1}), kFloat, "VEC3", 3);
  return gltf;
}

TEST(GltfPose, PosesASkinByItsJointsAndNotByItsNode) {
  const auto file = skinned_gltf().read();
  ASSERT_TRUE(file.ok()) << file.status();
  const MeshData& mesh = file->meshes[0];
  EXPECT_EQ(mesh.scene_from_mesh, MeshData().scene_from_mesh);
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 3}, Vec3{0, 1, 1.5f}));
  EXPECT_THAT(mesh.triangles, ElementsAre(0, 1, 2));
  EXPECT_THAT(file->warnings, ElementsAre());
}

TEST(GltfPose, TurnsNormalsAndTrianglesOfSkinsThatMirror) {
  Gltf gltf = skinned_gltf({0, 0, 0});
  gltf["nodes"][1] = {{"scale", {1, 1, -2}}, {"children", {2}}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 2, 1));
  EXPECT_EQ(file->meshes[0].normals[0], (Vec3{0, 0, -1}));
}

TEST(GltfPose, KeepsTheBindPoseOfASkinThatTheSceneDoesNotReach) {
  Gltf gltf = skinned_gltf();
  gltf["scenes"] = {{{"nodes", {0}}}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(in_scene(file->meshes[0], 1), (Vec3{51, 0, 0}));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 skins that cannot be applied"));
}

TEST(GltfPose, LeavesVerticesOfNoWeightAsTheyAre) {
  Gltf gltf = skinned_gltf();
  gltf.primitive()["attributes"]["WEIGHTS_0"] = gltf.add_accessor(
      Gltf::positions({0, 0, 0, 0, 2, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0}), kFloat, "VEC4", 3);
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 3}, Vec3{0, 1, 0}));
}

TEST(GltfPose, RefusesSkinsThatReferToNothing) {
  for (const auto& [pointer, value, reason] :
       {std::tuple{"/nodes/0/skin", json(4), "skin 4, there are 1"},
        {"/skins/0/joints", json{1, 9}, "joint 1 is node 9, skin 0, there are 3"},
        {"/skins/0/joints", json::array({1}), "joint 1 of vertex 1, mesh 0 primitive 0, skin 0 has 1 joints"},
        {"/skins/0/joints", json{1, 2, 1}, "2 inverse bind matrices, skin 0, must be 3..65536"},
        {"/skins/0/joints", json{1, "2"}, "joints of the wrong type, skins 0, must be an array of integers"},
        {"/skins/0/inverseBindMatrices", json(0), "must be MAT4 of floats"},
        {"/skins", json(3), "skins is not an array"},
        {"/accessors/3/count", json(2), "2 elements, accessor 3, must be 3"},
        {"/accessors/4/type", json("VEC3"), "accessor 4, must be VEC4"}}) {
    Gltf gltf = skinned_gltf();
    gltf.patch(pointer, value);
    const auto file = gltf.read();
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << pointer << ": " << file.status();
    EXPECT_THAT(message(file), HasSubstr(reason)) << pointer;
  }
}

}  // namespace
}  // namespace diaphane::testing

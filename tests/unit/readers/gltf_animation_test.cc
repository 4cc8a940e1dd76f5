// Animations of glTF, evaluated.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "diaphane/animation.h"
#include "tests/unit/readers/gltf_builder.h"

namespace diaphane::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

absl::StatusOr<AnimatedFile> read_animated(Gltf& gltf, const ReadLimits& limits = {}) {
  const ScratchFolder folder;
  return AnimatedFile::read(folder.write("scene.glb", gltf.as_glb()), limits);
}

std::string refusal(Gltf gltf) { return std::string(read_animated(gltf).status().message()); }

/// The builder's triangle, whose node 0 is moved.
Gltf moved(const char* path, const char* type, const std::vector<float>& times, const std::vector<float>& values,
           const char* interpolation = "LINEAR") {
  Gltf gltf;
  const size_t width = type == std::string("SCALAR") ? 1 : type == std::string("VEC3") ? 3 : 4;
  const int input = gltf.add_accessor(Gltf::positions(times), kFloat, "SCALAR", times.size());
  const int output = gltf.add_accessor(Gltf::positions(values), kFloat, type, values.size() / width);
  gltf["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}}};
  return gltf;
}

/// Where the vertex at (1, 0, 0) is at `seconds`.
Vec3 at(const AnimatedFile& file, double seconds) {
  const auto poses = file.pose(0, seconds);
  if (!poses.ok()) ADD_FAILURE() << poses.status();
  return poses.ok() ? poses->at(0).positions.at(1) : Vec3{};
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-5);
  EXPECT_NEAR(a.y, b.y, 1e-5);
  EXPECT_NEAR(a.z, b.z, 1e-5);
}

TEST(GltfAnimation, MovesANodeLinearlyAndHoldsItsEnds) {
  Gltf gltf = moved("translation", "VEC3", {1, 3}, {0, 0, 0, 4, 0, 8});
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->animations(), SizeIs(1));
  EXPECT_EQ(file->animations()[0].name, "animation 0");
  EXPECT_EQ(file->animations()[0].duration_s, 3);
  expect_near(at(*file, 0), {1, 0, 0});
  expect_near(at(*file, 1.5), {2, 0, 2});
  expect_near(at(*file, 3), {5, 0, 8});
  expect_near(at(*file, 99), {5, 0, 8});
}

TEST(GltfAnimation, StepsHoldUntilTheNextKey) {
  Gltf gltf = moved("translation", "VEC3", {0, 1, 2}, {0, 0, 0, 5, 0, 0, 9, 0, 0}, "STEP");
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  expect_near(at(*file, 0.99), {1, 0, 0});
  expect_near(at(*file, 1), {6, 0, 0});
  expect_near(at(*file, 5), {10, 0, 0});
}

TEST(GltfAnimation, SplinesFollowTheirTangents) {
  // In-tangent, value, out-tangent a key: from 0 with slope 2 to 1 with slope 0, over two seconds.
  Gltf gltf =
      moved("translation", "VEC3", {0, 2}, {7, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 0, 7, 0, 0}, "CUBICSPLINE");
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  expect_near(at(*file, 0), {1, 0, 0});
  // Hermite at one half: p0/2 + p1/2 + (m0 − m1)·2/8.
  expect_near(at(*file, 1), {1 + 0.5f + 0.5f, 0, 0});
  expect_near(at(*file, 2), {2, 0, 0});
}

TEST(GltfAnimation, TurnsAlongTheShorterGreatArc) {
  const float half = std::sqrt(0.5f);
  // From no turn to a quarter round z, whose quaternion is given with the other sign.
  Gltf gltf = moved("rotation", "VEC4", {0, 1}, {0, 0, 0, 1, 0, 0, -half, -half});
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  expect_near(at(*file, 1.0 / 3), {std::cos(float(M_PI) / 6), std::sin(float(M_PI) / 6), 0});
  expect_near(at(*file, 1), {0, 1, 0});
}

TEST(GltfAnimation, KeepsWhatAScaleOfNothingFlattens) {
  Gltf gltf = moved("scale", "VEC3", {0, 1}, {0, 0, 0, 2, 2, 2});
  gltf["nodes"][0]["scale"] = {0, 0, 0};
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->rest().meshes, SizeIs(1));
  expect_near(at(*file, 0), {0, 0, 0});
  expect_near(at(*file, 1), {2, 0, 0});
}

TEST(GltfAnimation, TurnsMirroredMeshesOutwardAndTheirNormalsAlong) {
  Gltf gltf = moved("translation", "VEC3", {0}, {0, 0, 0});
  gltf["nodes"][0]["scale"] = {-2, 1, 1};
  gltf.primitive()["attributes"]["NORMAL"] =
      gltf.add_accessor(Gltf::positions({0, 0, 1, 1, 0, 0, 0, 0, 1}), kFloat, "VEC3", 3);
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  const MeshData& mesh = file->rest().meshes[0];
  EXPECT_EQ(mesh.scene_from_mesh, MeshData().scene_from_mesh);
  EXPECT_THAT(mesh.triangles, ElementsAre(0, 2, 1));
  expect_near(mesh.positions[1], {-2, 0, 0});
  expect_near(mesh.normals[0], {0, 0, 1});
  expect_near(mesh.normals[1], {-1, 0, 0});
  expect_near(file->pose(0, 0)->at(0).normals[1], {-1, 0, 0});
}

Gltf morphing(const std::vector<float>& weights) {
  Gltf gltf = moved("weights", "SCALAR", {0, 1}, weights);
  const int up = gltf.add_accessor(Gltf::positions({0, 0, 1, 0, 0, 1, 0, 0, 1}), kFloat, "VEC3", 3);
  const int right = gltf.add_accessor(Gltf::positions({4, 0, 0, 4, 0, 0, 4, 0, 0}), kFloat, "VEC3", 3);
  gltf.primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  return gltf;
}

TEST(GltfAnimation, MorphsByWeights) {
  Gltf gltf = morphing({0, 1, 1, 0});
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  expect_near(at(*file, 0), {5, 0, 0});
  expect_near(at(*file, 0.25), {4, 0, 0.25f});
  expect_near(at(*file, 1), {1, 0, 1});
}

TEST(GltfAnimation, NamesWhatIsWrongWithIt) {
  const auto linear = [] { return moved("translation", "VEC3", {0, 1}, {0, 0, 0, 1, 0, 0}); };
  Gltf gltf = linear();
  gltf["animations"][0]["channels"][0]["target"]["node"] = 7;
  EXPECT_THAT(refusal(gltf), HasSubstr("node 7, animation 0, there are 1"));
  gltf = linear();
  gltf["animations"][0]["channels"][0]["sampler"] = 3;
  EXPECT_THAT(refusal(gltf), HasSubstr("sampler 3, animation 0, there are 1"));
  gltf = linear();
  gltf["animations"][0]["samplers"][0]["interpolation"] = "SINE";
  EXPECT_THAT(refusal(gltf), HasSubstr("must be STEP, LINEAR or CUBICSPLINE"));
  gltf = linear();
  gltf["animations"][0]["samplers"][0]["output"] = 99;
  EXPECT_THAT(refusal(gltf), HasSubstr("accessor 99"));
  gltf = linear();
  gltf["animations"][0]["channels"] = 3;
  EXPECT_THAT(refusal(gltf), HasSubstr("channels missing"));
  gltf = linear();
  gltf["animations"] = 3;
  EXPECT_THAT(refusal(gltf), HasSubstr("animations is not an array"));
  EXPECT_THAT(refusal(moved("translation", "VEC3", {1, 1}, {0, 0, 0, 1, 0, 0})), HasSubstr("key 1 at 1 s"));
  EXPECT_THAT(refusal(moved("translation", "VEC3", {0, 1}, {0, 0, 0})), HasSubstr("must be 2"));
  EXPECT_THAT(refusal(moved("translation", "VEC3", {0}, {0, NAN, 0})), HasSubstr("must be finite"));
  EXPECT_THAT(refusal(morphing({0, 1})), HasSubstr("must be 4"));
  gltf = linear();
  const auto file = read_animated(gltf);
  EXPECT_EQ(file->pose(1, 0).status().code(), absl::StatusCode::kOutOfRange);
  const ScratchFolder folder;
  EXPECT_TRUE(absl::IsInvalidArgument(AnimatedFile::read(folder.write("a.obj", "v 0 0 0\n")).status()));
}

TEST(GltfAnimation, LeavesOutWhatItDoesNotKnowAndSaysSo) {
  Gltf gltf = moved("translation", "VEC3", {0}, {1, 0, 0});
  gltf["animations"][0]["channels"][0]["target"]["path"] = "pointer";
  const auto unknown = read_animated(gltf);
  ASSERT_TRUE(unknown.ok()) << unknown.status();
  EXPECT_THAT(unknown->rest().warnings, ElementsAre("left out: channels that move something unknown, animation 0"));
  EXPECT_THAT(refusal(moved("rotation", "VEC4", {0}, {0, 0, 0, 1})), "");
}

TEST(GltfAnimation, APoseWithoutARotationIsRefusedWhenItIsAskedFor) {
  Gltf gltf = moved("rotation", "VEC4", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1});
  const auto file = read_animated(gltf);
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(std::string(file->pose(0, 0).status().message()), HasSubstr("a rotation of length 0"));
  EXPECT_TRUE(file->pose(0, 1).ok());
}

TEST(SharedAnimations, PlayWithFinitePositionsThatMove) {
  const fs::path folder = fs::path(DIAPHANE_SOURCE_DIR) / ".." / "shared" / "data" / "meshes" / "gltf";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  int played = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto file = AnimatedFile::read(entry.path());
    ASSERT_TRUE(file.ok()) << file.status();
    for (size_t a = 0; a < file->animations().size(); ++a) {
      SCOPED_TRACE(entry.path().filename().string() + " " + file->animations()[a].name);
      double most = 0;
      const auto first = file->pose(a, 0);
      ASSERT_TRUE(first.ok()) << first.status();
      for (int step = 1; step < 11; ++step) {
        const auto later = file->pose(a, step * file->animations()[a].duration_s / 11);
        ASSERT_TRUE(later.ok()) << later.status();
        ASSERT_EQ(later->size(), file->rest().meshes.size());
        for (size_t m = 0; m < later->size(); ++m) {
          ASSERT_EQ((*later)[m].positions.size(), file->rest().meshes[m].positions.size());
          for (size_t v = 0; v < (*later)[m].positions.size(); ++v) {
            const Vec3 p = (*first)[m].positions[v], q = (*later)[m].positions[v];
            most = std::max<double>(most, std::hypot(p.x - q.x, p.y - q.y, p.z - q.z));
          }
        }
      }
      EXPECT_GT(most, 0);
      ++played;
    }
  }
  EXPECT_GE(played, 10);
}

}  // namespace
}  // namespace diaphane::testing

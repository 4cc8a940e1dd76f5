#include <gmock/gmock.h>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr char kSquare[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

absl::StatusOr<LoadedFile> read_obj(const std::string& text) { return read_bytes("mesh.obj", text); }

TEST(ObjReader, KeepsTheOrderOfVertices) {
  const auto file = read_obj(std::string(kSquare) + "f 3 4 1\n");
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(1));
  const MeshData& mesh = file->meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
  EXPECT_THAT(mesh.triangles, ElementsAre(2, 3, 0));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_FALSE(file->millimetres_per_unit.has_value());
}

TEST(ObjReader, CountsNegativeIndicesBackFromTheFace) {
  const auto file = read_obj(std::string(kSquare) + "f -4 -3 -2\nv 5 5 5\nf -1 -5 -4\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 4, 0, 1));
}

TEST(ObjReader, TakesFacesBeforeTheirVertices) {
  const auto file = read_obj(std::string("f 1 2 3\n") + kSquare);
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
}

TEST(ObjReader, SplitsVerticesByNormalAndTextureCoordinate) {
  const auto file = read_obj(std::string(kSquare) +
                             "vt 0 0\nvt 1 0.25\nvn 0 0 1\nvn 1 0 0\n"
                             "f 1/1/1 2/2/1 3/1/1\nf 1/2/1 3/1/2 4/1/2\nf 1/2/1 2//1 3/1/2\n");
  ASSERT_TRUE(file.ok()) << file.status();
  const MeshData& mesh = file->meshes[0];
  EXPECT_THAT(mesh.triangles, ElementsAre(0, 1, 2, 4, 5, 3, 4, 1, 5));
  ASSERT_THAT(mesh.positions, SizeIs(6));
  EXPECT_EQ(mesh.positions[4], (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.positions[5], (Vec3{1, 1, 0}));
  const Vec3 up{0, 0, 1}, side{1, 0, 0};
  EXPECT_THAT(mesh.normals, ElementsAre(up, up, up, side, up, side));
  // Counted from above.
  const TextureCoordinate first{0, 1}, second{1, 0.75f};
  EXPECT_THAT(mesh.texture_coordinates, ElementsAre(first, second, first, first, second, first));
}

TEST(ObjReader, GivesAVertexWhatItsLaterCornersName) {
  const auto file = read_obj(std::string(kSquare) + "vt 1 0\nvn 0 0 1\nf 1 2 3\nf 1//1 2 3\nf 1/1 3 4\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, SizeIs(4));
  EXPECT_EQ(file->meshes[0].normals[0], (Vec3{0, 0, 1}));
  EXPECT_THAT(file->meshes[0].texture_coordinates,
              ElementsAre(TextureCoordinate{1, 1}, TextureCoordinate{}, TextureCoordinate{}, TextureCoordinate{}));
}

TEST(ObjReader, ReadsColoursAsSrgb) {
  const auto file = read_obj("v 0 0 0 1 0.5 0\nv 1 0 0 1.0\nv 0 1 0 1.0 0 1 0.04045\nv 1 1 0 nan 0 0\nf 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  const std::vector<Rgb>& colors = file->meshes[0].colors;
  ASSERT_THAT(colors, SizeIs(4));
  EXPECT_FLOAT_EQ(colors[0].r, 1);
  EXPECT_NEAR(colors[0].g, 0.21404, 1e-5);  // IEC 61966-2-1 at 0.5
  EXPECT_EQ(colors[1], (Rgb{1, 1, 1}));     // a weight alone
  EXPECT_NEAR(colors[2].b, 0.0031308, 1e-7);
  EXPECT_EQ(colors[3], (Rgb{1, 1, 1}));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 colours that are not finite"));
}

TEST(ObjReader, ReadsColoursOfBytesWhereOneIsAboveOne) {
  const auto file = read_obj("v 0 0 0 255 0 0\nv 1 0 0 127.5 1 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_FLOAT_EQ(file->meshes[0].colors[0].r, 1);
  EXPECT_NEAR(file->meshes[0].colors[1].r, 0.21404, 1e-5);
}

TEST(ObjReader, KeepsColoursOfVerticesThatItCopies) {
  const auto file = read_obj(
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0 0 0\nvn 0 0 1\nvn 1 0 0\n"
      "f 1//1 2//1 3//1 4//1\nf 3//2 2//2 1//1\n");
  ASSERT_TRUE(file.ok()) << file.status();
  const Rgb red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, black{0, 0, 0};
  EXPECT_THAT(file->meshes[0].colors, ElementsAre(red, green, blue, black, blue, green));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 0, 2, 3, 4, 5, 0));
}

TEST(ObjReader, LeavesVerticesWithoutANormalAtZero) {
  const auto file = read_obj(std::string(kSquare) + "vn 0 0 2\nf 1//1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].normals, ElementsAre(Vec3{0, 0, 2}, Vec3{}, Vec3{}, Vec3{}));
}

TEST(ObjReader, JoinsContinuedLinesAndTakesEveryLineEnd) {
  const auto file = read_obj("v 0 0 0 # one\r\nv 1 0 0\rv 1 1 \\\n 0\nf 1 2\\\r\n 3");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
}

TEST(ObjReader, PassesOverWhatIsNoSurface) {
  const auto file = read_obj(std::string("mtllib a b.mtl\no f 1 2 3\ng\nusemtl x\ns 1\n") + kSquare +
                             "l 1 2\np 1\nvt 0\nvp 0 0\nf 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, SizeIs(3));
  EXPECT_THAT(file->warnings, ElementsAre());
}

TEST(ObjReader, WarnsOfUnknownStatementsAndDegenerateFaces) {
  const auto file = read_obj(std::string(kSquare) + "curv 0 1 1 2\nf 1 2 3\nf 1 1 2\nf 1 2\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr("1 statements of unknown kinds, the first \"curv\" at line 5"),
                                          HasSubstr("2 faces with fewer than three")));
}

TEST(ObjReader, ReadsNumbersAsWrittenByManyTools) {
  const auto file = read_obj("v +1 .5 -.5e+00\nv 1e-999 2. 3 1\nv 1 2 3 0.5 0.5 0.5\nf 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{1, 0.5f, -0.5f}, Vec3{0, 2, 3}, Vec3{1, 2, 3}));
}

struct Refused {
  const char* tail;
  const char* reason;
};

class ObjRefusal : public ::testing::TestWithParam<Refused> {};

TEST_P(ObjRefusal, NamesTheLine) {
  const auto file = read_obj(std::string(kSquare) + GetParam().tail);
  EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(message(file), HasSubstr(GetParam().reason));
}

INSTANTIATE_TEST_SUITE_P(
    Obj, ObjRefusal,
    ::testing::Values(Refused{"f 1 2 5\n", "vertex index 5, line 5, must be 1..4 or -4..-1"},
                      Refused{"f 1 2 0\n", "vertex index 0, line 5"}, Refused{"f 1 2 -5\n", "vertex index -5, line 5"},
                      Refused{"f 1 2 99999999999999999999\n", "face corner \"99999999999999999999\", line 5"},
                      Refused{"f 1//1 2//1 3//1\n", "normal index 1, line 5, there are none"},
                      Refused{"f 1/1 2/1 3/1\n", "texture coordinate index 1, line 5, there are none"},
                      Refused{"vt 0 0\nf 1/0 2/1 3/1\n", "face corner \"1/0\", line 6"},
                      Refused{"vt x\nf 1 2 3\n", "texture coordinate \"x\", line 5, must be a number"},
                      Refused{"vt\nf 1 2 3\n", "texture coordinate ends early, line 5, must have 1 numbers"},
                      Refused{"f 1/1/1/1 2 3\n", "face corner \"1/1/1/1\", line 5"},
                      Refused{"f 1x 2 3\n", "face corner \"1x\", line 5"},
                      Refused{"v 1 2\nf 1 2 3\n", "position ends early, line 5"},
                      Refused{"v 1 2 nan\nf 1 2 3\n", "position 1, 2, nan, line 5, must be finite"},
                      Refused{"v 1 2 1e39\nf 1 2 3\n", "line 5, must be finite"},
                      Refused{"v 1 2 -1e999\nf 1 2 3\n", "line 5, must be finite"},
                      Refused{"", "nothing to render: it has no triangle (vertices: 4)"}));

TEST(ObjRefusals, AreOneLineThatNamesTheFile) {
  const auto file = read_obj("v 1 2 3\nf \x01\x1b[31m\n");
  EXPECT_THAT(message(file), ::testing::MatchesRegex(".*/mesh\\.obj: face corner \"..\\[31m\", line 2, must be .*"));
  EXPECT_THAT(message(file), ::testing::Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace diaphane::testing

#include <gmock/gmock.h>

#include <limits>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

absl::StatusOr<LoadedFile> read_off(const std::string& text) { return read_bytes("mesh.off", text); }
absl::StatusOr<LoadedFile> read_stl(const std::string& bytes) { return read_bytes("mesh.stl", bytes); }

TEST(OffReader, ReadsPolygonsAndPassesOverColours) {
  const auto file =
      read_off("OFF\n# a square\n4 2 0\n0 0 0\n1 0 0 # corner\n\n1 1 0\n0 1 0\n4 0 1 2 3 1 0 0\n3 0 2 3\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, SizeIs(4));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 0, 2, 3, 0, 2, 3));
}

TEST(OffReader, ReadsColoursWithAndWithoutAlphaAndTextureCoordinates) {
  const auto bytes = read_off("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 0\n3 0 1 2\n");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_THAT(bytes->meshes[0].colors, ElementsAre(Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 0}));
  const auto floats = read_off(
      "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 0.5 0 1 0.25 1\n1 0 0 0 0 1 0 0 0 0.5 0\n0 1 0 0 0 1 0 0 0 1 0 0\n3 0 1 2\n");
  ASSERT_TRUE(floats.ok()) << floats.status();
  EXPECT_NEAR(floats->meshes[0].colors[0].g, 0.21404, 1e-5);
  EXPECT_THAT(floats->meshes[0].texture_coordinates,
              ElementsAre(TextureCoordinate{0.25f, 0}, TextureCoordinate{0.5f, 1}, TextureCoordinate{0, 1}));
  EXPECT_THAT(message(read_off("COFF\n3 1 0\n0 0 0 1 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
              HasSubstr("2 numbers after position and normal, line 3, must be 3 or more"));
}

TEST(OffReader, ReadsNormalsBeforeColours) {
  const auto file = read_off("CNOFF 3 1 0\n0 0 0 0 0 1 9 9 9 9\n1 0 0 0 0 1 9 9 9 9\n0 1 0 0 1 0 9 9 9 9\n3 0 1 2\n");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].normals, ElementsAre(Vec3{0, 0, 1}, Vec3{0, 0, 1}, Vec3{0, 1, 0}));
}

TEST(OffReader, RefusesWhatDoesNotAddUp) {
  const auto too_many = read_off("OFF\n4000000000 1 0\n0 0 0\n");
  EXPECT_EQ(too_many.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(message(too_many), HasSubstr("4000000000 vertices and 1 faces, line 2, cannot be in 25 bytes"));
  EXPECT_THAT(message(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
              HasSubstr("vertex index 3, line 6, must be 0..2"));
  EXPECT_THAT(message(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n")), HasSubstr("vertex index -1, line 6"));
  EXPECT_THAT(message(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n")), HasSubstr("ends before its last face"));
  EXPECT_THAT(message(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n5 0 1 2\n")),
              HasSubstr("vertex index \"\", line 6, must be 5 integers"));
  EXPECT_THAT(message(read_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999 0 1 2\n")),
              HasSubstr("99999999 corners of a polygon, must be at most 1000000"));
  EXPECT_THAT(message(read_off("OFF\n-3 1 0\n")), HasSubstr("count of vertices \"-3\", line 2"));
  EXPECT_THAT(message(read_off("OFF\n0 0 0\n")), HasSubstr("nothing to render"));
}

TEST(OffReader, NamesTheKindsThatItDoesNotRead) {
  EXPECT_EQ(read_off("4OFF\n1 1 1\n").status().code(), absl::StatusCode::kUnimplemented);
  EXPECT_EQ(read_off("OFF BINARY\n").status().code(), absl::StatusCode::kUnimplemented);
}

std::string stl_triangle(const std::array<Vec3, 3>& corners) {
  std::string bytes = raw(0.0f) + raw(0.0f) + raw(1.0f);
  for (const Vec3& corner : corners) bytes += raw(corner.x) + raw(corner.y) + raw(corner.z);
  return bytes + raw(uint16_t{0});
}

std::string binary_stl(uint32_t count, const std::string& triangles) {
  return std::string("solid or not", 12) + std::string(68, '\0') + raw(count) + triangles;
}

TEST(StlReader, WeldsCornersAtBitEqualPositions) {
  const auto file = read_stl(binary_stl(2, stl_triangle({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}) +
                                               stl_triangle({Vec3{-0.0f, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}})));
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, SizeIs(4));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST(StlReader, ReadsASolidAsAMesh) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const auto file = read_stl("SOLID left part\n" + facet + "endsolid\nsolid\nendsolid\nsolid right\n" + facet + facet +
                             "endsolid right\n");
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(2));
  EXPECT_EQ(file->meshes[0].name, "left part");
  EXPECT_EQ(file->meshes[1].name, "right");
  EXPECT_THAT(file->meshes[1].triangles, ElementsAre(0, 1, 2, 0, 1, 2));
}

TEST(StlReader, RefusesWhatDoesNotAddUp) {
  const std::string triangle = stl_triangle({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}});
  EXPECT_THAT(message(read_stl(binary_stl(4000000000u, triangle))),
              HasSubstr("4000000000 triangles, byte 80, there is room for 1"));
  EXPECT_THAT(message(read_stl("short")), HasSubstr("5 bytes, binary STL has at least 84"));
  EXPECT_THAT(message(read_stl(binary_stl(0, ""))), HasSubstr("nothing to render"));
  const std::string bad = stl_triangle({Vec3{0, 0, std::numeric_limits<float>::quiet_NaN()}, Vec3{}, Vec3{}});
  EXPECT_THAT(message(read_stl(binary_stl(1, bad))), HasSubstr("position 0, 0, nan, byte 96, must be finite"));
  EXPECT_THAT(message(read_stl("solid\nfacet normal 0 0 1\nvertex 0 0 0\nendfacet\n")),
              HasSubstr("a facet of 1 vertices ends, line 4"));
  EXPECT_THAT(message(read_stl("solid\nfacet normal 0 0 1\nvertex 0 0 0\n")), HasSubstr("ends within a facet, line 3"));
  EXPECT_THAT(message(read_stl("solid\nfacet normal 0 0 1\nbanana\n")), HasSubstr("\"banana\" is no keyword"));
}

}  // namespace
}  // namespace diaphane::testing

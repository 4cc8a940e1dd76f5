#include "geometry/topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "geometry/shape.h"
#include "glm/geometric.hpp"
#include "glm/gtc/matrix_transform.hpp"

namespace diaphane::geometry {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two triangles of a unit square in z = 0 that share no vertex, only places.
const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<glm::uvec3> kTriangles = {{0, 1, 2}, {3, 4, 5}};

PlacedShape place(const MeshTopology& topology, const MeshShape& shape, const glm::mat4& scene_from_mesh,
                  double scale) {
  PlacedShape placed;
  place_positions(shape, scene_from_mesh, scale, placed);
  std::vector<glm::vec3> scratch;
  place_normals(topology, shape, scene_from_mesh, placed, scratch);
  return placed;
}

TEST(BuildTopology, WeldsBitEqualPositions) {
  const auto mesh = build_topology(kSquare, kTriangles);
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ((*mesh)->weld_count, 4u);
  EXPECT_THAT((*mesh)->weld_of_vertex, ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST(BuildTopology, ListsTheTrianglesOfEachWeld) {
  const auto mesh = build_topology(kSquare, kTriangles);
  ASSERT_TRUE(mesh.ok());
  EXPECT_THAT((*mesh)->first_triangle, ElementsAre(0, 2, 3, 5, 6));
  EXPECT_THAT((*mesh)->triangle_of_weld, ElementsAre(0, 1, 0, 0, 1, 1));
}

TEST(BuildTopology, RejectsAnIndexPastTheLastVertex) {
  const auto mesh = build_topology(kSquare, {{0, 1, 6}});
  EXPECT_EQ(mesh.status().message(), "indices[2]: must be below vertex_count 6, got 6");
}

TEST(BuildTopology, RejectsNoTriangle) {
  EXPECT_THAT(std::string(build_topology(kSquare, {}).status().message()), HasSubstr("triangle_count"));
}

TEST(BuildTopology, RejectsPositionsThatAreNotFinite) {
  std::vector<glm::vec3> positions = kSquare;
  positions[4].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(std::string(build_topology(positions, kTriangles).status().message()), HasSubstr("positions[4].y"));
  positions[4].y = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(build_topology(positions, kTriangles).ok());
}

TEST(Place, ScalesToMillimetresAndComputesNormals) {
  const auto mesh = *build_topology(kSquare, kTriangles);
  const PlacedShape placed = place(*mesh, {kSquare, {}}, glm::translate(glm::mat4(1), {0, 0, 2}), 10);
  EXPECT_EQ(placed.positions_mm[2], glm::vec3(10, 10, 20));
  EXPECT_EQ(placed.normals[0], glm::vec3(0, 0, 1));
  EXPECT_FALSE(placed.flipped);
}

TEST(Place, KeepsNormalsOutwardUnderAMirror) {
  const auto mesh = *build_topology(kSquare, kTriangles);
  const glm::mat4 mirror = glm::scale(glm::mat4(1), {-1, 1, 1});
  const PlacedShape computed = place(*mesh, {kSquare, {}}, mirror, 1);
  EXPECT_TRUE(computed.flipped);
  EXPECT_EQ(computed.normals[0], glm::vec3(0, 0, 1));
  const PlacedShape given = place(*mesh, {kSquare, std::vector<glm::vec3>(6, {0, 0, 3})}, mirror, 1);
  EXPECT_EQ(given.normals[0], glm::vec3(0, 0, 1));
}

TEST(Place, TiltsGivenNormalsByTheInverseTranspose) {
  const auto mesh = *build_topology(kSquare, kTriangles);
  const glm::vec3 slanted = glm::normalize(glm::vec3(1, 0, 1));
  const PlacedShape placed =
      place(*mesh, {kSquare, std::vector<glm::vec3>(6, slanted)}, glm::scale(glm::mat4(1), {2, 1, 1}), 1);
  EXPECT_NEAR(glm::dot(placed.normals[0], glm::normalize(glm::vec3(0.5f, 0, 1))), 1, 1e-6);
}

TEST(Place, ReplacesGivenNormalsOfNoLength) {
  const auto mesh = *build_topology(kSquare, kTriangles);
  const PlacedShape placed = place(*mesh, {kSquare, std::vector<glm::vec3>(6, {0, 0, 0})}, glm::mat4(1), 1);
  EXPECT_EQ(placed.normals[3], glm::vec3(0, 0, 1));
}

}  // namespace
}  // namespace diaphane::geometry

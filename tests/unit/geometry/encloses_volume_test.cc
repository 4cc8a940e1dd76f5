#include <gtest/gtest.h>

#include "geometry/topology.h"

namespace diaphane::geometry {
namespace {

const std::vector<glm::vec3> kCorners = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
const std::vector<glm::uvec3> kTetrahedron = {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}};

bool encloses(const std::vector<glm::vec3>& corners, const std::vector<glm::uvec3>& triangles) {
  return (*build_topology(corners, triangles))->encloses_volume;
}

TEST(EnclosesVolume, AClosedBodySeenFromOutside) { EXPECT_TRUE(encloses(kCorners, kTetrahedron)); }

TEST(EnclosesVolume, VerticesApartAtTheSamePlaceAreOne) {
  std::vector<glm::vec3> corners;
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec3& t : kTetrahedron) {
    const auto first = static_cast<uint32_t>(corners.size());
    for (int k = 0; k < 3; ++k) corners.push_back(kCorners[t[k]]);
    triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_TRUE(encloses(corners, triangles));
}

TEST(EnclosesVolume, NotWithAHole) { EXPECT_FALSE(encloses(kCorners, {kTetrahedron.begin(), kTetrahedron.end() - 1})); }

TEST(EnclosesVolume, NotWithATriangleTurnedRound) {
  auto triangles = kTetrahedron;
  std::swap(triangles[2].x, triangles[2].y);
  EXPECT_FALSE(encloses(kCorners, triangles));
}

TEST(EnclosesVolume, NotInsideOut) {
  auto triangles = kTetrahedron;
  for (glm::uvec3& t : triangles) std::swap(t.x, t.y);
  EXPECT_FALSE(encloses(kCorners, triangles));
}

TEST(EnclosesVolume, NotWithAThirdTriangleAtAnEdge) {
  auto corners = kCorners;
  corners.emplace_back(5, 5, 5);
  auto triangles = kTetrahedron;
  triangles.emplace_back(0, 1, 4);
  EXPECT_FALSE(encloses(corners, triangles));
}

TEST(EnclosesVolume, TrianglesWithoutAreaByTheirCornersDoNotCount) {
  auto triangles = kTetrahedron;
  triangles.emplace_back(0, 0, 1);
  EXPECT_TRUE(encloses(kCorners, triangles));
}

}  // namespace
}  // namespace diaphane::geometry

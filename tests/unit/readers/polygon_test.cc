#include "readers/polygon.h"

#include <gmock/gmock.h>

#include <cmath>

namespace diaphane::readers {
namespace {

using ::testing::ElementsAre;

double signed_area_xy(const std::vector<Vec3>& p, const PolygonSplitter::Triangle& t) {
  const Vec3 &a = p[t[0]], &b = p[t[1]], &c = p[t[2]];
  return 0.5 * ((double{b.x} - a.x) * (double{c.y} - a.y) - (double{b.y} - a.y) * (double{c.x} - a.x));
}

// Triangles of a polygon in the xy plane, counter-clockwise, with the given area: all turned the same way, none too
// many.
void expect_tiling(const std::vector<Vec3>& polygon, double area) {
  PolygonSplitter splitter;
  const auto triangles = splitter.split(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double sum = 0;
  for (const auto& triangle : triangles) {
    EXPECT_GE(signed_area_xy(polygon, triangle), 0);
    sum += signed_area_xy(polygon, triangle);
  }
  EXPECT_NEAR(sum, area, 1e-5 * area);
  EXPECT_EQ(splitter.fanned(), 0u);
}

TEST(PolygonSplitter, FansConvexPolygons) {
  PolygonSplitter splitter;
  const std::vector<Vec3> pentagon = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 2, 0}, {-1, 1, 0}};
  EXPECT_THAT(splitter.split(pentagon),
              ElementsAre(PolygonSplitter::Triangle{0, 1, 2}, PolygonSplitter::Triangle{0, 2, 3},
                          PolygonSplitter::Triangle{0, 3, 4}));
}

TEST(PolygonSplitter, SplitsConcaveQuadsAlongTheInnerDiagonal) {
  expect_tiling({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 4);
  expect_tiling({{4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 0, 0}}, 4);
}

TEST(PolygonSplitter, TilesAComb) {
  std::vector<Vec3> comb = {{0, 0, 0}, {20, 0, 0}};
  for (int tooth = 9; tooth >= 0; --tooth) {
    comb.push_back({2.0f * tooth + 2, 5, 0});
    comb.push_back({2.0f * tooth + 1, 1, 0});
  }
  comb.push_back({0, 5, 0});
  // Teeth of base 2 and depth 4 are cut out of a block of 20 by 5; the last one ends at its left side.
  expect_tiling(comb, 20 * 5 - 9 * 4 - 4);
}

TEST(PolygonSplitter, KeepsTheWindingInEveryPlane) {
  PolygonSplitter splitter;
  for (int plane = 0; plane < 6; ++plane) {
    std::vector<Vec3> quad;
    for (const auto& [u, v] : {std::pair{0.f, 0.f}, {4.f, 0.f}, {1.f, 1.f}, {0.f, 4.f}}) {
      const Vec3 points[] = {{u, v, 0}, {0, u, v}, {v, 0, u}, {v, u, 0}, {0, v, u}, {u, 0, v}};
      quad.push_back(points[plane]);
    }
    const Vec3 normals[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {0, -1, 0}};
    for (const auto& [a, b, c] : splitter.split(quad)) {
      const Vec3 u{quad[b].x - quad[a].x, quad[b].y - quad[a].y, quad[b].z - quad[a].z};
      const Vec3 v{quad[c].x - quad[a].x, quad[c].y - quad[a].y, quad[c].z - quad[a].z};
      const Vec3& n = normals[plane];
      EXPECT_GT(n.x * (u.y * v.z - u.z * v.y) + n.y * (u.z * v.x - u.x * v.z) + n.z * (u.x * v.y - u.y * v.x), 0);
    }
  }
}

TEST(PolygonSplitter, GivesFlatPolygonsTheRightNumberOfTriangles) {
  PolygonSplitter splitter;
  EXPECT_EQ(splitter.split(std::vector<Vec3>(7, Vec3{1, 2, 3})).size(), 5u);
  EXPECT_EQ(splitter.split(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2u);
  EXPECT_EQ(splitter.split(std::vector<Vec3>{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 3, 0}, {1, -1, 0}}).size(), 3u);
}

TEST(PolygonSplitter, FansHugeConcavePolygonsAndSaysSo) {
  std::vector<Vec3> star;
  const int corners = 2 * PolygonSplitter::kMostClippedCorners;
  for (int i = 0; i < corners; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / corners;
    star.push_back({(1 + i % 2) * std::cos(angle), (1 + i % 2) * std::sin(angle), 0});
  }
  PolygonSplitter splitter;
  EXPECT_EQ(splitter.split(star).size(), star.size() - 2);
  EXPECT_EQ(splitter.fanned(), 1u);
}

}  // namespace
}  // namespace diaphane::readers

// The gallery's own meshes are bodies that light can be in.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <utility>

#include "gallery/candle.h"
#include "gallery/horned_head.h"
#include "gallery/morph.h"

namespace diaphane::gallery {
namespace {

// By the divergence theorem: positive where triangles wind outward.
double volume_of(const MeshData& mesh) {
  double volume = 0;
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vec3& a = mesh.positions[mesh.triangles[i]];
    const Vec3& b = mesh.positions[mesh.triangles[i + 1]];
    const Vec3& c = mesh.positions[mesh.triangles[i + 2]];
    volume += (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) / 6;
  }
  return volume;
}

// Directed edges that do not have exactly one other way round.
size_t open_edges(const MeshData& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> count;
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) ++count[{mesh.triangles[i + k], mesh.triangles[i + (k + 1) % 3]}];
  }
  size_t open = 0;
  for (const auto& [edge, times] : count) {
    const auto other = count.find({edge.second, edge.first});
    if (times != 1 || other == count.end()) ++open;
  }
  return open;
}

TEST(Candle, IsClosedAndWoundOutward) {
  const CandleShape shape;
  const MeshData mesh = candle(shape);
  EXPECT_EQ(open_edges(mesh), 0);
  const double cylinder = M_PI * shape.radius * shape.radius * shape.height;
  EXPECT_GT(volume_of(mesh), 0.8 * cylinder);
  EXPECT_LT(volume_of(mesh), 1.05 * cylinder);
  EXPECT_EQ(open_edges(wick(shape)), 0);
  EXPECT_GT(volume_of(wick(shape)), 0);
}

TEST(Candle, HasItsFlameInTheHollow) {
  const CandleShape shape;
  const Vec3 light = flame(shape);
  double rim = 0;
  double floor = shape.height;
  for (const Vec3& p : candle(shape).positions) {
    rim = std::max<double>(rim, p.y);
    if (std::hypot(p.x, p.z) < 0.5f * shape.radius && p.y > 1) floor = std::min<double>(floor, p.y);
  }
  EXPECT_LT(light.y, rim);
  EXPECT_GT(light.y, floor);
}

TEST(HornedHead, IsClosedWoundOutwardAndHasHorns) {
  const MeshData mesh = horned_head(4);
  EXPECT_EQ(mesh.triangles.size(), 3 * 20 * 256);
  EXPECT_EQ(open_edges(mesh), 0);
  EXPECT_GT(volume_of(mesh), 1);
  size_t horn = 0;
  size_t skull = 0;
  for (const Vec3& p : mesh.positions) {
    horn += on_horn(p) ? 1 : 0;
    skull += on_skull(p) ? 1 : 0;
    EXPECT_FALSE(on_horn(p) && on_skull(p));
  }
  EXPECT_GT(horn, 20);
  EXPECT_GT(skull, mesh.positions.size() / 3);
}

TEST(Morph, EndsOnTheSphereAndCanBeTakenBack) {
  const MeshData mesh = horned_head(3);
  const auto sphere = bounding_sphere(mesh);
  ASSERT_TRUE(sphere.ok());
  const auto& [c, r] = *sphere;
  for (const Vec3& p : morphed(mesh.positions, *sphere, 1)) {
    EXPECT_NEAR(std::hypot(p.x - c.x, p.y - c.y, p.z - c.z), r, 1e-5);
  }
  const std::vector<Vec3> half = morphed(mesh.positions, *sphere, 0.5f);
  for (size_t i = 0; i < half.size(); ++i) {
    const Vec3 back = unmorphed(half[i], *sphere, 0.5f);
    EXPECT_NEAR(back.x, mesh.positions[i].x, 1e-4);
    EXPECT_NEAR(back.y, mesh.positions[i].y, 1e-4);
    EXPECT_NEAR(back.z, mesh.positions[i].z, 1e-4);
  }
}

}  // namespace
}  // namespace diaphane::gallery

#include "geometry/creases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "glm/common.hpp"
#include "glm/geometric.hpp"

namespace diaphane::geometry {
namespace {

/// Triangles that share nothing: every edge is a crease.
struct Soup {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

Soup make_soup(uint32_t count, float extent, float size, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(-extent, extent), near(-size, size);
  Soup soup;
  for (uint32_t t = 0; t < count; ++t) {
    const glm::vec3 centre(anywhere(random), anywhere(random), anywhere(random));
    for (int k = 0; k < 3; ++k) soup.positions.push_back(centre + glm::vec3(near(random), near(random), near(random)));
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return soup;
}

float distance_to_segment(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b) {
  const float t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0f, 1.0f);
  return glm::distance(p, a + t * (b - a));
}

class CreaseFieldTest : public ::testing::TestWithParam<float> {};

TEST_P(CreaseFieldTest, AgreesWithTheNearestEdgeOfAll) {
  constexpr float kReach = 2;
  const Soup soup = make_soup(60, GetParam(), 1, 7);
  const auto mesh = build_topology(soup.positions, soup.triangles);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const CreaseField field(**mesh, soup.positions, kReach);
  std::mt19937 random(8);
  std::uniform_real_distribution<float> anywhere(-GetParam() - 3, GetParam() + 3);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p(anywhere(random), anywhere(random), anywhere(random));
    float nearest = kReach;
    for (const glm::uvec3& t : soup.triangles) {
      for (int k = 0; k < 3; ++k)
        nearest = std::min(nearest, distance_to_segment(p, soup.positions[t[k]], soup.positions[t[(k + 1) % 3]]));
    }
    const float found = field.distance_mm(p);
    EXPECT_GE(found, nearest - 1e-4f);
    EXPECT_LE(found, std::min(kReach, nearest + 0.25f * kReach) + 1e-4f);
  }
}

INSTANTIATE_TEST_SUITE_P(DenseAndSparse, CreaseFieldTest, ::testing::Values(2.0f, 12.0f));

TEST(CreaseField, HasReachWhereNothingBends) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto mesh = build_topology(positions, {{0, 1, 2}, {0, 2, 1}});
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(CreaseField(**mesh, positions, 0.5f).distance_mm({9, 9, 9}), 0.5f);
}

}  // namespace
}  // namespace diaphane::geometry

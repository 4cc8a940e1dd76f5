#include "render/shadow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/topology.h"
#include "glm/geometric.hpp"
#include "tests/support/meshes.h"

namespace diaphane::render {
namespace {

using testing::Mesh;

geometry::PlacedShape shape_of(const Mesh& mesh) { return {mesh.positions_mm, mesh.normals, false}; }

LightStorage point_light(const glm::vec3& position_mm) {
  return {.position_mm = glm::vec4(position_mm, 0), .power = {1, 1, 1, 0}};
}

/// A mesh that casts shadows on itself.
struct Body {
  explicit Body(const Mesh& mesh, bool encloses_volume = true) : triangles(mesh.triangles), shape(shape_of(mesh)) {
    bounds = geometry::bounds_of(shape.positions_mm);
    const ShadowCaster caster{triangles, shape.positions_mm, encloses_volume, false};
    shadows.set_casters({&caster, 1}, bounds);
  }
  std::vector<float> visibility(const LightStorage& light) {
    std::vector<float> share(triangles.size());
    shadows.visibility(light, triangles, shape, share);
    return share;
  }
  /// The same by rays, one triangle at a time.
  std::vector<float> by_rays(const LightStorage& light) {
    shadows.prepare_rays();
    std::vector<float> share;
    for (const glm::uvec3& t : triangles) {
      const glm::vec3 &a = shape.positions_mm[t.x], &b = shape.positions_mm[t.y], &c = shape.positions_mm[t.z];
      share.push_back(shadows.visibility_at(light, (a + b + c) / 3.0f, glm::normalize(glm::cross(b - a, c - a))));
    }
    return share;
  }
  std::vector<glm::uvec3> triangles;
  geometry::PlacedShape shape;
  geometry::Bounds bounds;
  ShadowScene shadows;
};

/// The share of triangles on whose visibility the two disagree by more than a half.
double disagreement(const std::vector<float>& a, const std::vector<float>& b) {
  size_t differ = 0;
  for (size_t i = 0; i < a.size(); ++i) differ += std::abs(a[i] - b[i]) > 0.5f ? 1 : 0;
  return static_cast<double>(differ) / static_cast<double>(a.size());
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

TEST(ShadowMap, AgreesWithRaysOnATorus) {
  Body torus(testing::make_torus(7, 3, 160, 64));
  for (const LightStorage& light : {point_light({25, 8, 6}), point_light({0, 20, 15}),
                                    LightStorage{.position_mm = {0.8f, 0, 0.6f, 0}, .power = {1, 1, 1, 1}}}) {
    ASSERT_TRUE(ShadowMap::serves(light, torus.bounds));
    const auto map = torus.visibility(light), rays = torus.by_rays(light);
    EXPECT_LT(disagreement(map, rays), 0.02);
    EXPECT_NEAR(mean(map), mean(rays), 0.01);
    EXPECT_GT(mean(rays), 0.2) << "the light sees something";
  }
}

TEST(ShadowMap, SeesTheNearSideOfAnOpenSheet) {
  Mesh sheet = testing::make_box({20, 20, 1}, 1);
  sheet.triangles.resize(sheet.triangles.size() / 2);
  Body open(sheet, false);
  const LightStorage light = point_light({3, 4, 40});
  EXPECT_LT(disagreement(open.visibility(light), open.by_rays(light)), 0.02);
}

TEST(ShadowMap, MirroredCastersShadeTheSame) {
  const Mesh torus = testing::make_torus(7, 3, 96, 48);
  Body straight(torus);
  Mesh mirrored = torus;
  for (glm::vec3& p : mirrored.positions_mm) p.x = -p.x;
  geometry::PlacedShape shape = shape_of(mirrored);
  shape.flipped = true;
  ShadowScene shadows;
  const ShadowCaster caster{mirrored.triangles, shape.positions_mm, true, true};
  shadows.set_casters({&caster, 1}, geometry::bounds_of(shape.positions_mm));
  std::vector<float> share(mirrored.triangles.size());
  shadows.visibility(point_light({-25, 8, 6}), mirrored.triangles, shape, share);
  EXPECT_NEAR(mean(share), mean(straight.visibility(point_light({25, 8, 6}))), 0.01);
}

TEST(ShadowMap, LeavesNearAndSoftLightsToRays) {
  const geometry::Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_TRUE(ShadowMap::serves(point_light({0, 0, 5}), bounds));
  EXPECT_FALSE(ShadowMap::serves(point_light({0, 0, 1.5f}), bounds));
  LightStorage soft = point_light({0, 0, 5});
  soft.shape.y = 0.2f;
  EXPECT_FALSE(ShadowMap::serves(soft, bounds));
}

TEST(Shadows, ALightInsideAHollowBodyLightsItsWallsAlone) {
  const Mesh cup = testing::make_cup(7, 20, 2, 0.7f);
  Body body(cup);
  const LightStorage lamp = point_light({0, 0, 2});
  ASSERT_FALSE(ShadowMap::serves(lamp, body.bounds));
  const auto share = body.visibility(lamp);
  for (size_t t = 0; t < share.size(); ++t) {
    const glm::uvec3& i = cup.triangles[t];
    const glm::vec3 centre = (cup.positions_mm[i.x] + cup.positions_mm[i.y] + cup.positions_mm[i.z]) / 3.0f;
    if (glm::length(glm::vec2(centre)) <= 6.9f) continue;
    EXPECT_EQ(share[t], 0.0f) << "outer wall";
  }
  EXPECT_GT(mean(share), 0.2);
}

}  // namespace
}  // namespace diaphane::render

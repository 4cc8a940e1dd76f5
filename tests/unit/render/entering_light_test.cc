#include "render/entering_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "glm/geometric.hpp"
#include "render/lights.h"

namespace diaphane::render {
namespace {

glm::vec3 random_vector(std::mt19937& random, float size) {
  std::uniform_real_distribution<float> one(-size, size);
  return {one(random), one(random), one(random)};
}

struct Case {
  const char* name;
  LightStorage light;
};

class EnteringLightOf : public ::testing::TestWithParam<Case> {};

TEST_P(EnteringLightOf, IsWhatThePointByPointFormulaGives) {
  std::mt19937 random(3);
  constexpr size_t kCount = 211;
  SurfacePoints points{};
  std::vector<glm::vec3> expected(kCount);
  std::vector<float> seen(SurfacePoints::kCapacity, 0);
  for (size_t i = 0; i < kCount; ++i) {
    const glm::vec3 position = random_vector(random, 10), normal = glm::normalize(random_vector(random, 1));
    points.set(i, position, normal);
    seen[i] = i % 5 == 0 ? 0.25f : 1.0f;
    expected[i] = seen[i] * entering_irradiance(GetParam().light, position, normal, 1.4f);
  }
  EnteringLight sum{};
  add_entering_light(GetParam().light, 1.4f, points, kCount, seen.data(), sum);
  // The cone's edge makes thirty times as much of a cosine's rounding.
  float brightest = 0;
  for (const glm::vec3& e : expected) brightest = std::max({brightest, e.x, e.y, e.z});
  size_t lit = 0;
  for (size_t i = 0; i < kCount; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum.channel[c][i], expected[i][c], 1e-5f * brightest) << i;
    lit += expected[i].x > 0 ? 1 : 0;
  }
  EXPECT_GT(lit, 10u);
  EXPECT_LT(lit, kCount - 10);
}

TEST_P(EnteringLightOf, AddsToWhatIsThere) {
  SurfacePoints points{};
  for (size_t i = 0; i < 16; ++i) points.set(i, {0, 0, 0}, {0, 0, 1});
  EnteringLight once{}, twice{};
  add_entering_light(GetParam().light, 1.4f, points, 16, nullptr, once);
  add_entering_light(GetParam().light, 1.4f, points, 16, nullptr, twice);
  add_entering_light(GetParam().light, 1.4f, points, 16, nullptr, twice);
  EXPECT_GT(once.channel[0][0], 0);
  EXPECT_FLOAT_EQ(twice.channel[0][0], 2 * once.channel[0][0]);
}

TEST_P(EnteringLightOf, OfASurfaceThatDoesNotBendItIsFiniteAtEveryAngle) {
  SurfacePoints points{};
  std::vector<glm::vec3> expected(16);
  for (size_t i = 0; i < 16; ++i) {
    // From full face over grazing to away.
    const float turn = static_cast<float>(i) / 8;
    const glm::vec3 normal = i == 8 ? glm::vec3(0, 1, 0) : glm::normalize(glm::vec3(0, turn, 1 - turn));
    points.set(i, {0, 0, 0}, normal);
    expected[i] = entering_irradiance(GetParam().light, {0, 0, 0}, normal, 1);
  }
  EnteringLight sum{};
  add_entering_light(GetParam().light, 1, points, 16, nullptr, sum);
  EXPECT_GT(expected[0].x, 0);
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(sum.channel[0][i], expected[i].x, 1e-4f * expected[0].x) << i;
}

const LightStorage kPoint{.position_mm = {5, 6, 30, 0}, .power = {900, 500, 100, 0}};
const LightStorage kDirectional{.position_mm = {0.6f, 0, 0.8f, 0}, .power = {1, 2, 3, 1}};
const LightStorage kSpot{.position_mm = {0, 0, 30, 0},
                         .power = {900, 500, 100, 0},
                         .axis = {0, 0, -1, 0.955f},
                         .shape = {1 / (0.985f - 0.955f), 0, 0, 0}};

INSTANTIATE_TEST_SUITE_P(Lights, EnteringLightOf,
                         ::testing::Values(Case{"point", kPoint}, Case{"directional", kDirectional},
                                           Case{"spot", kSpot}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace diaphane::render

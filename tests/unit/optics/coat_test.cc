#include "optics/coat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "glm/geometric.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

glm::vec3 direction(float cosine, float azimuth) {
  const float sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// ∫ f μi dωi over the hemisphere, by the midpoints of a grid in polar angle and azimuth: no draws of the coat's own.
double whole_reflectance(const BalancedCoat& coat, float cosine) {
  constexpr int kPolar = 900, kAzimuth = 500;
  const glm::vec3 to_eye = direction(cosine, 0);
  double sum = 0;
  for (int i = 0; i < kPolar; ++i) {
    const double polar = (i + 0.5) / kPolar * std::numbers::pi / 2;
    double ring = 0;
    for (int j = 0; j < kAzimuth; ++j) {
      const auto azimuth = static_cast<float>((j + 0.5) / kAzimuth * std::numbers::pi);
      ring += coat.reflectance(direction(static_cast<float>(std::cos(polar)), azimuth), to_eye);
    }
    sum += ring * std::cos(polar) * std::sin(polar);
  }
  return sum * (std::numbers::pi / 2 / kPolar) * (2 * std::numbers::pi / kAzimuth);
}

TEST(Coats, InAWhiteFurnaceGiveBackWhatTheBodyDoesNotTake) {
  for (const float index : {1.3f, 1.5f, 2.0f}) {
    for (const float roughness : {0.05f, 0.2f, 0.5f, 1.0f}) {
      const BalancedCoat coat({roughness}, index);
      for (const float cosine : {0.1f, 0.3f, 0.6f, 0.9f, 1.0f}) {
        const double in_all = whole_reflectance(coat, cosine) + fresnel_transmittance(index, cosine);
        EXPECT_NEAR(in_all, 1, 0.01) << "index " << index << ", roughness " << roughness << ", cosine " << cosine;
      }
    }
  }
}

TEST(Coats, ReflectAlikeBothWays) {
  for (const float roughness : {0.0f, 0.1f, 0.6f, 1.0f}) {
    const BalancedCoat coat({roughness}, 1.5f);
    for (const float a : {0.05f, 0.4f, 0.95f}) {
      for (const float b : {0.1f, 0.5f, 0.99f}) {
        const glm::vec3 one = direction(a, 0.3f), other = direction(b, 2.9f);
        const float there = coat.reflectance(one, other);
        EXPECT_GT(there, 0);
        EXPECT_NEAR(coat.reflectance(other, one), there, 1e-4f * there);
      }
    }
  }
}

TEST(Coats, DrawWhatTheyReflect) {
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    const BalancedCoat coat({roughness}, 1.4f);
    const glm::vec3 to_eye = direction(0.7f, 0);
    for (const glm::vec2 random : {glm::vec2(0.1f, 0.2f), glm::vec2(0.2f, 0.9f), glm::vec2(0.3f, 0.2f)}) {
      const BalancedCoat::Arrival drawn = coat.arrival(to_eye, random);
      ASSERT_GT(drawn.weight, 0);
      const float expected = coat.reflectance(drawn.direction, to_eye) * drawn.direction.z / drawn.density;
      EXPECT_NEAR(drawn.weight, expected, 1e-3f * expected);
    }
  }
}

TEST(Coats, ThatAreSmoothAreMirrors) {
  const BalancedCoat coat({0}, 1.5f);
  const glm::vec3 to_eye = direction(0.5f, 0);
  const BalancedCoat::Arrival drawn = coat.arrival(to_eye, {0.4f, 0.7f});
  EXPECT_NEAR(drawn.direction.x, -to_eye.x, 0.01f);
  EXPECT_NEAR(drawn.direction.z, to_eye.z, 0.01f);
  EXPECT_NEAR(drawn.weight, 1 - fresnel_transmittance(1.5f, 0.5f), 2e-3f);
}

TEST(Coats, ReflectNothingFromBelow) {
  const BalancedCoat coat({0.5f}, 1.5f);
  EXPECT_EQ(coat.reflectance({0.6f, 0, -0.8f}, {0, 0, 1}), 0);
  EXPECT_EQ(coat.reflectance({0, 0, 1}, {0.6f, 0, -0.8f}), 0);
}

}  // namespace
}  // namespace diaphane::optics

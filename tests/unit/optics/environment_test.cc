#include "optics/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

LatLongMap map_of(uint32_t height_px, const std::function<glm::vec3(const glm::vec3&)>& radiance) {
  LatLongMap map{2 * height_px, height_px, {}};
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) map.radiance.push_back(radiance(map.direction(x, y)));
  }
  return map;
}

TEST(LatLongMap, HasUpAboveAndTheMiddleColumnAtMinusZ) {
  const LatLongMap map{400, 200, {}};
  EXPECT_GT(map.direction(0, 0).y, 0.999f);
  EXPECT_LT(glm::distance(map.direction(200, 100), glm::vec3(0, 0, -1)), 0.02f);
  EXPECT_LT(glm::distance(map.direction(300, 100), glm::vec3(1, 0, 0)), 0.02f);
  double sum = 0;
  for (uint32_t y = 0; y < map.height_px; ++y) sum += map.width_px * map.solid_angle(y);
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-9);
}

TEST(Harmonics, AreOrthonormal) {
  double products[kHarmonics][kHarmonics] = {};
  const LatLongMap map{256, 128, {}};
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const glm::dvec3 d = map.direction(x, y);
      double p[kHarmonics];
      harmonic_polynomials<double, double>(d.x, d.y, d.z, p);
      for (size_t i = 0; i < kHarmonics; ++i) {
        for (size_t j = 0; j <= i; ++j) products[i][j] += map.solid_angle(y) * p[i] * p[j];
      }
    }
  }
  for (size_t i = 0; i < kHarmonics; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      const double product = products[i][j] * std::sqrt(harmonic_norms()[i] * harmonic_norms()[j]);
      EXPECT_NEAR(product, i == j ? 1 : 0, 2e-3) << i << " " << j;
    }
  }
}

TEST(EnteringBands, AreTheClampedCosinesAtAnIndexOfOne) {
  const auto bands = entering_bands(1);
  const float expected[] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24};
  for (size_t l = 0; l < kHarmonicBands; ++l) EXPECT_NEAR(bands[l], expected[l], 1e-3f) << l;
}

TEST(EnteringBands, LoseWhatTheSurfaceReflects) {
  for (const float eta : {1.3f, 1.5f, 2.0f}) {
    // A finer sum, in the angle.
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const double angle = (i + 0.5) * std::numbers::pi / 2 / 20000;
      sum += std::sin(angle) * std::cos(angle) * fresnel_transmittance(eta, static_cast<float>(std::cos(angle)));
    }
    EXPECT_NEAR(entering_bands(eta)[0], sum * std::numbers::pi / 20000 * std::numbers::pi, 2e-3);
  }
  EXPECT_NEAR(entering_bands(1.5f)[0], 2.8533f, 5e-4f);
}

TEST(Environment, OfOneRadianceGivesTheSameEverywhere) {
  const EnvironmentLight light = analyse(map_of(64, [](const glm::vec3&) { return glm::vec3(2, 1, 0.5f); }));
  EXPECT_TRUE(light.lamps.empty());
  const Harmonics irradiance = irradiance_harmonics(light.radiance, 1.5f);
  for (const glm::vec3& normal : spread_directions(50)) {
    const glm::vec3 e = evaluate(irradiance, normal);
    EXPECT_NEAR(e.r, 2 * 2.8533f, 6e-3f);
    EXPECT_NEAR(e.b, 0.5f * 2.8533f, 2e-3f);
  }
}

TEST(Environment, ThatIsSmoothIsGivenByItsHarmonics) {
  const LatLongMap map =
      map_of(64, [](const glm::vec3& d) { return glm::vec3(1 + d.y, 1 + 0.8f * d.x * d.z, std::exp(0.7f * d.z)); });
  EXPECT_LT(harmonics_error(map, spread_directions(60), 1.4f), 0.003);
}

TEST(TakeOutLamps, FindsASunWithItsDirectionAndStrength) {
  const glm::vec3 to_sun = glm::normalize(glm::vec3(0.6f, 0.5f, -0.4f));
  const float solid_angle = 2 * kPi * (1 - std::cos(0.03f));
  LatLongMap map = map_of(256, [&](const glm::vec3& d) {
    const glm::vec3 sky(0.3f, 0.5f, 0.8f + 0.2f * d.y);
    return glm::acos(glm::min(glm::dot(d, to_sun), 1.0f)) < 0.03f ? sky + glm::vec3(3, 2, 1) / solid_angle : sky;
  });
  // The disc is as large as its pixels are together.
  double drawn_sr = 0;
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) {
      if (map.radiance[size_t{y} * map.width_px + x].r > 10) drawn_sr += map.solid_angle(y);
    }
  }
  const float drawn = static_cast<float>(drawn_sr) / solid_angle;
  const auto lamps = take_out_lamps(map);
  ASSERT_EQ(lamps.size(), 1u);
  EXPECT_GT(glm::dot(-lamps[0].direction, to_sun), 0.9999f);
  EXPECT_NEAR(lamps[0].irradiance.r, 3 * drawn, 0.03f);
  EXPECT_NEAR(lamps[0].irradiance.g, 2 * drawn, 0.02f);
  for (const glm::vec3& left : map.radiance) ASSERT_LT(left.b, 1.01f);
}

TEST(TakeOutLamps, FindsASunInAMapMuchWiderThanTall) {
  const glm::vec3 to_sun = glm::normalize(glm::vec3(-0.7f, 0.3f, 0.5f));
  LatLongMap map{2048, 63, {}};
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const bool in_sun = glm::dot(map.direction(x, y), to_sun) > std::cos(0.1f);
      map.radiance.push_back(in_sun ? glm::vec3(500) : glm::vec3(0.5f));
    }
  }
  const auto lamps = take_out_lamps(map);
  ASSERT_EQ(lamps.size(), 1u);
  EXPECT_GT(glm::dot(-lamps[0].direction, to_sun), 0.999f);
}

TEST(TakeOutLamps, LeavesAMapOfNoLightAlone) {
  LatLongMap map = map_of(8, [](const glm::vec3&) { return glm::vec3(0); });
  EXPECT_TRUE(take_out_lamps(map).empty());
}

TEST(Environment, TakesTheSmallestAndOddestMaps) {
  for (const auto& [width, height] : {std::pair{2u, 1u}, {3u, 2u}, {37u, 5u}, {8192u, 1u}, {2u, 4096u}, {1024u, 63u}}) {
    LatLongMap map{width, height, std::vector<glm::vec3>(size_t{width} * height, glm::vec3(1))};
    map.radiance[0] = glm::vec3(1e6f);
    const EnvironmentLight light = analyse(map);
    for (const glm::vec3& harmonic : light.radiance) EXPECT_TRUE(std::isfinite(harmonic.r));
  }
}

}  // namespace
}  // namespace diaphane::optics

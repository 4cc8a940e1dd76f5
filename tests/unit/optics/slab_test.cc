#include "optics/slab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "optics/presets.h"
#include "tests/support/random_walk.h"

namespace diaphane::optics {
namespace {

constexpr Profile kProfiles[] = {Profile::kDipole, Profile::kBetterDipole, Profile::kNormalizedDiffusion};

Coefficients grey(float albedo, float refractive_index) {
  return {.absorption_mm = glm::vec3(1 - albedo),
          .reduced_scattering_mm = glm::vec3(albedo),
          .refractive_index = refractive_index};
}

class SlabOfAlbedo : public ::testing::TestWithParam<std::pair<float, float>> {};

TEST_P(SlabOfAlbedo, GivesBackWhatARandomWalkDoesAtAnyThickness) {
  const auto [albedo, index] = GetParam();
  for (const double thickness : {0.005, 0.1, 0.5, 0.7, 1.0, 2.0, 4.0, 8.0, 40.0}) {
    const SlabResponse slab = Slab(grey(albedo, index)).response(thickness);
    const int walks = 100000;
    const testing::WalkedSlab walked = testing::walk_slab(albedo, index, thickness, walks);
    // Four standard deviations of the walk, at least one photon, and half a per cent.
    const auto near = [&](double share) { return 4 * std::sqrt((share + 1.0 / walks) / walks) + 0.005 * share; };
    EXPECT_NEAR(slab.reflected.x, walked.reflected, near(walked.reflected)) << "thickness " << thickness;
    EXPECT_NEAR(slab.transmitted.x, walked.transmitted, near(walked.transmitted)) << "thickness " << thickness;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SlabOfAlbedo,
                         ::testing::Values(std::pair(1.0f, 1.0f), std::pair(1.0f, 1.3f), std::pair(1.0f, 1.5f),
                                           std::pair(0.999f, 1.5f), std::pair(0.99f, 1.0f), std::pair(0.99f, 1.3f),
                                           std::pair(0.99f, 1.5f), std::pair(0.9f, 1.3f), std::pair(0.68f, 1.3f),
                                           std::pair(0.3f, 1.5f), std::pair(0.05f, 1.0f), std::pair(0.9f, 3.0f)));

TEST(Slab, GivesBackAtMostWhatEnteredAtAnyThickness) {
  for (const Profile profile : kProfiles) {
    for (const float index : {1.0f, 1.3f, 1.5f, 3.0f}) {
      for (const float albedo : {0.01f, 0.5f, 0.9f, 0.99f, 1.0f}) {
        Coefficients material = grey(albedo, index);
        material.profile = profile;
        const Slab of(material);
        for (double thickness = 1e-3; thickness < 1e5; thickness *= 2) {
          const SlabResponse slab = of.response(thickness);
          EXPECT_GE(slab.reflected.x, 0);
          EXPECT_GE(slab.transmitted.x, -1e-12);
          // Between thicknesses of the table.
          EXPECT_LE(slab.reflected.x + slab.transmitted.x, 1 + 2e-5) << albedo << " " << index << " " << thickness;
        }
      }
    }
  }
}

TEST(Slab, MakesOfThickBodiesTheHalfSpaceOfRadiativeTransfer) {
  for (const char* preset : {"marble", "wholemilk", "skin1"}) {
    Coefficients material = find_preset(preset)->coefficients;
    for (int c = 0; c < 3; ++c) {
      const float extinction = material.absorption_mm[c] + material.reduced_scattering_mm[c];
      const double albedo = material.reduced_scattering_mm[c] / extinction;
      const testing::WalkedSlab walked = testing::walk_slab(albedo, material.refractive_index, 400, 20000);
      for (const Profile profile : kProfiles) {
        material.profile = profile;
        const SlabGain gain = Slab(material).gain(1e5);
        EXPECT_NEAR(gain.own[c] * total_reflectance(material)[c], walked.reflected, 0.015)
            << preset << " channel " << c;
        EXPECT_NEAR(gain.opposite[c], 0, 5e-3) << preset;
      }
    }
  }
}

TEST(IntegralSlab, TransmitsTheIntegralOfTheProfileFromTheOtherFace) {
  for (const Profile profile : kProfiles) {
    Coefficients material = find_preset("skin1")->coefficients;
    material.profile = profile;
    const ReflectanceProfile rd = make_profile(material);
    for (const double thickness : {0.3, 1.0, 4.0}) {
      const SlabResponse slab = integral_slab_response(material, thickness);
      glm::dvec3 sum(0);
      for (double r = 1e-4; r < 1e3; r *= 1.005) {
        const auto distance = static_cast<float>(std::hypot(r, thickness));
        sum += glm::dvec3(diffuse_reflectance(rd, distance)) * (2 * std::numbers::pi * r * r * std::log(1.005));
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(slab.transmitted[c] / sum[c], 1, 2e-3) << thickness << " channel " << c;
    }
  }
}

TEST(IntegralSlab, GivesBackMoreThanEnteredWhereItIsThin) {
  const SlabResponse slab = integral_slab_response(grey(1, 1.5f), 1);
  EXPECT_GT(slab.reflected.x + slab.transmitted.x, 1.7);
}

TEST(SlabGain, MakesOfTheIntegralsFacesTheSlabs) {
  for (const Profile profile : kProfiles) {
    Coefficients material = find_preset("marble")->coefficients;
    material.profile = profile;
    const Slab slab(material);
    for (const double thickness : {0.2, 1.0, 5.0}) {
      const SlabResponse said = integral_slab_response(material, thickness);
      const SlabResponse right = slab.response(thickness);
      const SlabGain gain = slab.gain(thickness);
      // Lit with 3 through one face, 1 through the other.
      for (int c = 0; c < 3; ++c) {
        const double near = 3 * said.reflected[c] + said.transmitted[c];
        const double far = said.reflected[c] + 3 * said.transmitted[c];
        EXPECT_NEAR(gain.own[c] * near + gain.opposite[c] * far, 3 * right.reflected[c] + right.transmitted[c], 1e-4);
        EXPECT_NEAR(gain.own[c] * far + gain.opposite[c] * near, right.reflected[c] + 3 * right.transmitted[c], 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace diaphane::optics

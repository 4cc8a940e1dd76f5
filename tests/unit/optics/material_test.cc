#include "optics/material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glm/common.hpp"
#include "optics/presets.h"
#include "optics/profile.h"

namespace diaphane::optics {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr Profile kProfiles[] = {Profile::kDipole, Profile::kBetterDipole, Profile::kNormalizedDiffusion};

void expect_round_trip(const DiffuseColor& form, Profile profile) {
  const Coefficients resolved = resolve(form, profile).coefficients;
  const glm::vec3 color = total_reflectance(resolved);
  for (int c = 0; c < 3; ++c) {
    const float l = 1 / (resolved.absorption_mm[c] + resolved.reduced_scattering_mm[c]);
    EXPECT_GT(resolved.reduced_scattering_mm[c], 0);
    EXPECT_GE(resolved.absorption_mm[c], 0);
    EXPECT_NEAR(l / form.mean_free_path_mm[c], 1, 1e-3);
    // Relative, but for what is as good as black.
    EXPECT_NEAR(color[c], form.color[c], 1e-3f * form.color[c] + 1e-6f)
        << "profile " << static_cast<int>(profile) << " ior " << form.refractive_index << " l "
        << form.mean_free_path_mm[c];
  }
}

TEST(DiffuseColor, ComesBackOverTheWholeRange) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  for (const Profile profile : kProfiles) {
    for (int i = 0; i < 2000; ++i) {
      DiffuseColor form;
      form.refractive_index = 1 + 2 * share(random);
      for (int c = 0; c < 3; ++c) {
        form.color[c] = 0.999f * share(random);
        form.mean_free_path_mm[c] = std::pow(10.0f, -3 + 6 * share(random));
      }
      expect_round_trip(form, profile);
    }
  }
}

TEST(DiffuseColor, ComesBackAtTheEndsOfTheRange) {
  for (const Profile profile : kProfiles) {
    for (const float index : {1.0f, 1.3f, 3.0f}) {
      for (const float l : {0.001f, 1.0f, 1000.0f}) {
        expect_round_trip({glm::vec3(0, 1e-4f, 0.999f), glm::vec3(l), index}, profile);
        expect_round_trip({glm::vec3(0.99f, 0.5f, 0.998f), glm::vec3(l), index}, profile);
      }
    }
  }
}

TEST(DiffuseColor, PresetsComeBackFromTheirOwnColours) {
  for (const MaterialPreset& preset : material_presets()) {
    const Coefficients& known = preset.coefficients;
    const DiffuseColor form{glm::min(total_reflectance(known), 0.999f),
                            1.0f / (known.absorption_mm + known.reduced_scattering_mm), known.refractive_index};
    const Coefficients found = resolve(form, Profile::kDipole).coefficients;
    for (int c = 0; c < 3; ++c) {
      if (known.absorption_mm[c] == 0) continue;  // whiter than the form can say
      EXPECT_NEAR(found.absorption_mm[c] / known.absorption_mm[c], 1, 0.02) << preset.name << c;
      EXPECT_NEAR(found.reduced_scattering_mm[c] / known.reduced_scattering_mm[c], 1, 0.02) << preset.name << c;
    }
  }
}

TEST(Warnings, NameTheChannelInWhichDiffusionFails) {
  const Coefficients thin{.absorption_mm = {0.1f, 0.6f, 0.45f}, .reduced_scattering_mm = {0.9f, 0.4f, 0.55f}};
  EXPECT_THAT(resolve(thin, Profile::kDipole).warnings,
              ElementsAre(HasSubstr("green scatters too little"), HasSubstr("blue scatters too little")));
  EXPECT_THAT(resolve(thin, Profile::kBetterDipole).warnings, ElementsAre(HasSubstr("green scatters too little")));
  EXPECT_THAT(resolve(thin, Profile::kNormalizedDiffusion).warnings, IsEmpty());
}

TEST(Warnings, BoundIsWhereDiffuseLightFallsOffAsFastAsUnscatteredLight) {
  for (const Profile profile : {Profile::kDipole, Profile::kBetterDipole}) {
    const auto albedo = static_cast<float>(lowest_albedo(profile));
    const ReflectanceProfile at = make_profile(
        {.absorption_mm = glm::vec3(1 - albedo), .reduced_scattering_mm = glm::vec3(albedo), .profile = profile});
    EXPECT_NEAR(at[0].terms[0].transport_mm, 1, 1e-6);
  }
}

TEST(Volume, GreyFogIsItsAttenuationAndColour) {
  // e^(−σt·2 mm) = 0.25; isotropic.
  const Volume form{.attenuation_color = glm::vec3(0.25f),
                    .attenuation_distance_mm = 2,
                    .multiscatter_color = glm::vec3(0.8f),
                    .refractive_index = 1};
  const ResolvedMaterial resolved = resolve(form, Profile::kDipole);
  EXPECT_THAT(resolved.warnings, IsEmpty());
  const glm::vec3 extinction = resolved.coefficients.absorption_mm + resolved.coefficients.reduced_scattering_mm;
  EXPECT_NEAR(extinction.x, std::log(4.0) / 2, 1e-5);
  // Without a boundary the colour that was asked for is that of transport: the dipole is near it.
  EXPECT_NEAR(total_reflectance(resolved.coefficients).x, 0.8, 0.05);
}

TEST(Volume, ForwardScatteringKeepsTheColourAndReducesTheScattering) {
  Volume form{.attenuation_color = glm::vec3(0.1f),
              .attenuation_distance_mm = 1,
              .multiscatter_color = glm::vec3(0.3f, 0.6f, 0.9f),
              .refractive_index = 1};
  const Coefficients isotropic = resolve(form, Profile::kDipole).coefficients;
  form.scatter_anisotropy = 0.8f;
  const Coefficients forward = resolve(form, Profile::kDipole).coefficients;
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(forward.reduced_scattering_mm[c], 0.5f * isotropic.reduced_scattering_mm[c]);
    EXPECT_NEAR(total_reflectance(forward)[c], total_reflectance(isotropic)[c], 1e-4);
  }
}

TEST(Volume, ExtinctionBeyondTheRangeIsKeptWithinItWithAWarning) {
  const Volume form{
      .attenuation_color = {1, 1e-30f, 0.5f}, .attenuation_distance_mm = 1e-3f, .multiscatter_color = glm::vec3(0.9f)};
  const ResolvedMaterial resolved = resolve(form, Profile::kDipole);
  EXPECT_THAT(resolved.warnings, ElementsAre(HasSubstr("attenuation in red"), HasSubstr("attenuation in green")));
  const glm::vec3 extinction = resolved.coefficients.absorption_mm + resolved.coefficients.reduced_scattering_mm;
  EXPECT_NEAR(extinction.r, 1e-3, 1e-6);
  EXPECT_NEAR(extinction.g, 1e3, 1e-1);
}

}  // namespace
}  // namespace diaphane::optics

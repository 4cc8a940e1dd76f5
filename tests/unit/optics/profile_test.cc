#include "optics/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "optics/presets.h"

namespace diaphane::optics {
namespace {

constexpr Profile kProfiles[] = {Profile::kDipole, Profile::kBetterDipole, Profile::kNormalizedDiffusion};

/// ∫ Rd 2πr dr over log-spaced radii.
glm::dvec3 integrate_over_plane(const ReflectanceProfile& profile) {
  glm::dvec3 sum(0);
  constexpr double kStep = 1.01;
  for (double r = 1e-6; r < 1e4; r *= kStep) {
    const double next = r * kStep;
    const auto middle = static_cast<float>(0.5 * (r + next));
    sum += glm::dvec3(diffuse_reflectance(profile, middle)) * (std::numbers::pi * (next * next - r * r));
  }
  return sum;
}

TEST(Profile, IntegratesToTheClosedFormForEveryPreset) {
  for (const Profile kind : kProfiles) {
    for (const MaterialPreset& preset : material_presets()) {
      Coefficients material = preset.coefficients;
      material.profile = kind;
      const glm::dvec3 numeric = integrate_over_plane(make_profile(material));
      const glm::vec3 closed = total_reflectance(material);
      for (int c = 0; c < 3; ++c) {
        // Without absorption the tail beyond 10 m is what is missing.
        EXPECT_NEAR(numeric[c] / closed[c], 1, 0.002) << preset.name << " channel " << c << static_cast<int>(kind);
      }
    }
  }
}

TEST(Profile, DipoleIsTheClassicalOne) {
  for (const MaterialPreset& preset : material_presets()) {
    const ReflectanceProfile profile = make_profile(preset.coefficients);
    const Dipole dipole = make_dipole(preset.coefficients);
    for (const float r : {0.0f, 0.01f, 0.3f, 1.0f, 10.0f}) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(diffuse_reflectance(profile, r)[c] / diffuse_reflectance(dipole, r)[c], 1, 1e-4) << preset.name;
      }
    }
  }
}

TEST(Profile, GivesBackEverythingThatIsNotAbsorbed) {
  for (const Profile kind : kProfiles) {
    for (const double index : {1.0, 1.3, 2.0, 3.0}) EXPECT_NEAR(total_reflectance(kind, 0, index), 1, 1e-6) << index;
  }
}

TEST(Profile, ReflectsLessTheMoreIsAbsorbed) {
  for (const Profile kind : kProfiles) {
    for (const double index : {1.0, 1.3, 2.0, 3.0}) {
      double last = 2;
      for (double absorbed = 0; absorbed <= 1; absorbed += 1.0 / 256) {
        const double total = total_reflectance(kind, absorbed, index);
        EXPECT_LT(total, last);
        EXPECT_GE(total, 0);
        last = total;
      }
    }
  }
}

TEST(BetterDipole, FallsOffAsDiffusionDoesFarAway) {
  const Coefficients material{
      .absorption_mm = glm::vec3(0.1f), .reduced_scattering_mm = glm::vec3(0.9f), .profile = Profile::kBetterDipole};
  const ReflectanceProfile profile = make_profile(material);
  // σ = √(σa/D) with Grosjean's D = (2σa + σ's)/(3σ't²).
  const double transport = std::sqrt(0.1 / (1.1 / 3));
  EXPECT_NEAR(profile[0].terms[0].transport_mm, transport, 1e-6);
  // r² Rd falls by e^(−σ) a millimetre, to order 1/r.
  const double at100 = diffuse_reflectance(profile, 100)[0], at101 = diffuse_reflectance(profile, 101)[0];
  EXPECT_NEAR(std::log(at100 * 100 * 100 / (at101 * 101 * 101)), transport, 0.01 * transport);
}

TEST(NormalizedDiffusion, HasTheLimitsOfItsFormula) {
  const Coefficients material{.absorption_mm = glm::vec3(0.02f),
                              .reduced_scattering_mm = glm::vec3(1.98f),
                              .profile = Profile::kNormalizedDiffusion};
  const ReflectanceProfile profile = make_profile(material);
  const double a = total_reflectance(material).x;
  const double s = 1.9 - a + 3.5 * (a - 0.8) * (a - 0.8), l = 0.5;
  for (const double r : {1e-3, 0.1, 1.0, 5.0}) {
    const double expected =
        a * s / l * (std::exp(-s * r / l) + std::exp(-s * r / (3 * l))) / (8 * std::numbers::pi * r);
    EXPECT_NEAR(diffuse_reflectance(profile, static_cast<float>(r)).x / expected, 1, 1e-4) << r;
  }
  Coefficients classical = material;
  classical.profile = Profile::kDipole;
  EXPECT_NEAR(a, total_reflectance(classical).x, 1e-6);
}

TEST(FresnelMoment, FirstIsWhatTheFitFits) {
  for (const float index : {1.1f, 1.3f, 1.5f}) {
    EXPECT_NEAR(2 * fresnel_moment(1, index), diffuse_fresnel_reflectance(index), 0.01) << index;
  }
  EXPECT_EQ(fresnel_moment(1, 1), 0);
}

}  // namespace
}  // namespace diaphane::optics

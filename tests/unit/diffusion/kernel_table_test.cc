#include "diffusion/kernel_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>

#include "optics/presets.h"

namespace diaphane::diffusion {
namespace {

/// What a gather reads: value and derivatives of a table at r².
KernelValue looked_up(const KernelDomain& domain, const KernelTable& table, int channel, double distance2) {
  const double unclamped = std::sqrt(domain.scale * distance2 + 4);
  const double v = std::min(unclamped, double{KernelDomain::kLargest});
  const uint32_t segment = std::bit_cast<uint32_t>(static_cast<float>(v)) >> 23 & 7;
  double result[3];
  for (int derivative = 0; derivative < 3; ++derivative) {
    double sum = 0;
    for (int power = 3; power >= 0; --power) sum = sum * v + table.coefficient[derivative][channel][power][segment];
    result[derivative] = sum / std::pow(unclamped, 3 + 2 * derivative);
  }
  return {result[0], result[1], result[2]};
}

constexpr optics::Profile kProfiles[] = {optics::Profile::kDipole, optics::Profile::kBetterDipole,
                                         optics::Profile::kNormalizedDiffusion};

optics::Coefficients with_profile(std::string_view preset, optics::Profile profile) {
  optics::Coefficients material = optics::find_preset(preset)->coefficients;
  material.profile = profile;
  return material;
}

/// ∫ of work(r²) over the plane between two radii.
template <typename Work>
double over_plane(double from, double to, const Work& work) {
  double sum = 0;
  for (double r = from; r < to; r *= 1.005) sum += work(r * r) * 2 * std::numbers::pi * r * r * std::log(1.005);
  return sum;
}

TEST(CarriedKernel, IsTheReflectanceAndItsDerivatives) {
  for (const optics::Profile kind : kProfiles) {
    const optics::ReflectanceProfile profile = optics::make_profile(with_profile("skin1", kind));
    for (const optics::ChannelProfile& channel : profile) {
      const GaussianSum gaussians = fit_gaussians(channel);
      const auto c = &channel - profile.data();
      for (const double r2 : {0.0, 0.01, 0.3, 2.0, 30.0}) {
        const KernelValue k = carried_kernel(channel, gaussians, r2);
        const double h = 1e-4 * (r2 + 0.1);
        const KernelValue more = carried_kernel(channel, gaussians, r2 + h);
        const KernelValue less = carried_kernel(channel, gaussians, r2 - h);
        EXPECT_NEAR((more.value - less.value) / (2 * h) / k.first, 1, 1e-4) << r2;
        EXPECT_NEAR((more.first - less.first) / (2 * h) / k.second, 1, 1e-4) << r2;
        const double r = std::sqrt(r2);
        // Where what is left to the local term has died away.
        if (kind == optics::Profile::kNormalizedDiffusion && r < 3 * gaussians.deviation_mm[0]) continue;
        if (k.value < 1e-6 * channel.total) continue;
        EXPECT_NEAR(k.value / optics::diffuse_reflectance(profile, static_cast<float>(r))[static_cast<int>(c)], 1, 2e-3)
            << r << " channel " << c << " profile " << static_cast<int>(kind);
      }
    }
  }
}

TEST(KernelTables, AreCloseToTheProfileWhereverEnergyIs) {
  const std::vector<float> fine_leaves = {1e-8f};
  for (const optics::Profile kind : kProfiles) {
    for (const optics::MaterialPreset& preset : optics::material_presets()) {
      const optics::Coefficients material = with_profile(preset.name, kind);
      const optics::ReflectanceProfile profile = optics::make_profile(material);
      KernelSet kernels;
      kernels.set_material(material);
      kernels.prepare(30, fine_leaves);
      EXPECT_EQ(&kernels.near_table(locate_spacing(fine_leaves[0]).step), &kernels.far_table());
      for (int c = 0; c < 3; ++c) {
        const GaussianSum gaussians = fit_gaussians(profile[c]);
        // The share of ∫ Rd dA that the tables get wrong.
        double off = 0, total = 0;
        for (double r = 0.001; r < 25; r *= 1.01) {
          const double exact = carried_kernel(profile[c], gaussians, r * r).value;
          off += std::abs(looked_up(kernels.domain(), kernels.far_table(), c, r * r).value - exact) * r * r;
          total += exact * r * r;
        }
        EXPECT_LE(off / total, 0.003) << preset.name << " channel " << c << " profile " << static_cast<int>(kind);
      }
    }
  }
}

TEST(GaussianSum, FollowsTheDipolesWithoutNegativeWeights) {
  for (const optics::Profile kind : {optics::Profile::kDipole, optics::Profile::kBetterDipole}) {
    for (const char* name : {"marble", "skin1", "ketchup", "spectralon"}) {
      const optics::ReflectanceProfile profile = optics::make_profile(with_profile(name, kind));
      for (const optics::ChannelProfile& channel : profile) {
        const GaussianSum sum = fit_gaussians(channel);
        for (const double weight : sum.weight) EXPECT_GE(weight, 0);
        const double z = channel.smooth_mm;
        const double total =
            over_plane(0.001 * z, 120 * z, [&](double r2) { return carried_kernel(channel, sum, r2).value; });
        EXPECT_NEAR(sum.total() / total, 1, 0.02) << name << " profile " << static_cast<int>(kind);
      }
    }
  }
}

TEST(KernelTables, NearAndLocalPartsMakeUpTheWhole) {
  for (const optics::Profile kind : kProfiles) {
    const optics::Coefficients material = with_profile("wholemilk", kind);
    const optics::ReflectanceProfile profile = optics::make_profile(material);
    KernelSet kernels;
    kernels.set_material(material);
    const float spacing = 2 * kernels.smooth_mm();
    kernels.prepare(30, {spacing * spacing});
    const SpacingPosition at{locate_spacing(spacing * spacing).step, 0};
    ASSERT_NE(&kernels.near_table(at.step), &kernels.far_table());
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(kernels.local_response(at)[c], 0.05f);
      const double near = over_plane(
          0.0005, 14, [&](double r2) { return looked_up(kernels.domain(), kernels.near_table(at.step), c, r2).value; });
      const double beyond = over_plane(14, 1e4, [&](double r2) {
        return optics::diffuse_reflectance(profile, static_cast<float>(std::sqrt(r2)))[c];
      });
      EXPECT_NEAR((near + kernels.local_response(at)[c]) / (profile[c].total - beyond), 1, 0.003)
          << "profile " << static_cast<int>(kind) << " channel " << c;
    }
  }
}

TEST(LocateSpacing, FallsBetweenTheStepsAroundIt) {
  for (float spacing = 0.001f; spacing < 1000; spacing *= 1.07f) {
    const SpacingPosition at = locate_spacing(spacing * spacing);
    const float low = spacing_of_step(at.step), high = spacing_of_step(at.step + 1u);
    EXPECT_LE(low, spacing * 1.00001f);
    EXPECT_GE(high, spacing * 0.99999f);
    EXPECT_NEAR(low * low + at.share * (high * high - low * low), spacing * spacing, 1e-5f * spacing * spacing);
    EXPECT_LE(high / low, 1.13f) << "an eighth of an octave";
  }
}

TEST(LocateSpacing, StaysWithinTheSteps) {
  EXPECT_EQ(locate_spacing(0).step, 0);
  EXPECT_EQ(locate_spacing(0).share, 0);
  EXPECT_EQ(locate_spacing(1e38f).step, kSpacingSteps - 2);
  EXPECT_EQ(locate_spacing(1e38f).share, 1);
}

}  // namespace
}  // namespace diaphane::diffusion

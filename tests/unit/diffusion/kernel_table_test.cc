#include "diffusion/kernel_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

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

TEST(DipoleKernel, IsTheReflectanceAndItsDerivatives) {
  const optics::Dipole dipole = optics::make_dipole(optics::find_preset("skin1")->coefficients);
  for (int c = 0; c < 3; ++c) {
    for (const double r2 : {0.0, 0.01, 0.3, 2.0, 30.0}) {
      const KernelValue k = dipole_kernel(dipole, c, r2);
      EXPECT_NEAR(k.value / optics::diffuse_reflectance(dipole, static_cast<float>(std::sqrt(r2)))[c], 1, 1e-5);
      const double h = 1e-4 * (r2 + 0.1);
      const KernelValue more = dipole_kernel(dipole, c, r2 + h), less = dipole_kernel(dipole, c, r2 - h);
      EXPECT_NEAR((more.value - less.value) / (2 * h) / k.first, 1, 1e-5) << r2;
      EXPECT_NEAR((more.first - less.first) / (2 * h) / k.second, 1, 1e-5) << r2;
    }
  }
}

TEST(KernelTables, AreCloseToTheDipoleWhereverEnergyIs) {
  const std::vector<float> fine_leaves = {1e-8f};
  for (const optics::MaterialPreset& preset : optics::material_presets()) {
    const optics::Dipole dipole = optics::make_dipole(preset.coefficients);
    KernelSet kernels;
    kernels.set_material(preset.coefficients);
    kernels.prepare(30, fine_leaves);
    EXPECT_EQ(&kernels.near_table(locate_spacing(fine_leaves[0]).step), &kernels.far_table());
    for (int c = 0; c < 3; ++c) {
      // The share of ∫ Rd dA that the tables get wrong.
      double off = 0, total = 0;
      for (double r = 0.001; r < 25; r *= 1.01) {
        const double exact = dipole_kernel(dipole, c, r * r).value;
        off += std::abs(looked_up(kernels.domain(), kernels.far_table(), c, r * r).value - exact) * r * r;
        total += exact * r * r;
      }
      EXPECT_LE(off / total, 0.003) << preset.name << " channel " << c;
    }
  }
}

TEST(GaussianSum, FollowsTheDipoleWithoutNegativeWeights) {
  for (const char* name : {"marble", "skin1", "ketchup", "spectralon"}) {
    const optics::Dipole dipole = optics::make_dipole(optics::find_preset(name)->coefficients);
    for (int c = 0; c < 3; ++c) {
      const GaussianSum sum = fit_gaussians(dipole, c);
      double response = 0;
      for (int k = 0; k < GaussianSum::kTerms; ++k) {
        EXPECT_GE(sum.weight[k], 0);
        response += sum.weight[k] * 2 * std::numbers::pi * sum.deviation_mm[k] * sum.deviation_mm[k];
      }
      double total = 0;
      const double z = smooth_distance_mm(dipole)[c];
      for (double r = 0.001 * z; r < 120 * z; r *= 1.01) {
        total += dipole_kernel(dipole, c, r * r).value * 2 * std::numbers::pi * r * r * std::log(1.01);
      }
      EXPECT_NEAR(response / total, 1, 0.02) << name << " channel " << c;
    }
  }
}

TEST(KernelTables, NearAndLocalPartsMakeUpTheWhole) {
  const optics::Coefficients material = optics::find_preset("wholemilk")->coefficients;
  const optics::Dipole dipole = optics::make_dipole(material);
  KernelSet kernels;
  kernels.set_material(material);
  const float spacing = 2 * kernels.smooth_mm();
  kernels.prepare(30, {spacing * spacing});
  const SpacingPosition at{locate_spacing(spacing * spacing).step, 0};
  ASSERT_NE(&kernels.near_table(at.step), &kernels.far_table());
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(kernels.local_response(at)[c], 0.05f);
    double near = 0, whole = 0;
    for (double r = 0.0005; r < 14; r *= 1.005) {
      const double ring = 2 * std::numbers::pi * r * r * std::log(1.005);
      near += looked_up(kernels.domain(), kernels.near_table(at.step), c, r * r).value * ring;
      whole += dipole_kernel(dipole, c, r * r).value * ring;
    }
    EXPECT_NEAR((near + kernels.local_response(at)[c]) / whole, 1, 0.003);
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

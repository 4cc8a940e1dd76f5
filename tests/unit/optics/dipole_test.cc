#include "optics/dipole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "optics/presets.h"
#include "optics/profile.h"

namespace diaphane::optics {
namespace {

/// ∫ Rd 2πr dr over log-spaced radii.
glm::vec3 integrate_over_plane(const Dipole& dipole) {
  glm::vec3 sum(0);
  constexpr double kStep = 1.01;
  for (double r = 1e-5; r < 1e4; r *= kStep) {
    const double next = r * kStep;
    const auto middle = static_cast<float>(0.5 * (r + next));
    sum += diffuse_reflectance(dipole, middle) * static_cast<float>(std::numbers::pi * (next * next - r * r));
  }
  return sum;
}

TEST(Dipole, IntegratesToTheClosedFormForEveryPreset) {
  for (const MaterialPreset& preset : material_presets()) {
    const glm::vec3 numeric = integrate_over_plane(make_dipole(preset.coefficients));
    const glm::vec3 closed = total_reflectance(preset.coefficients);
    for (int c = 0; c < 3; ++c) {
      // Without absorption the tail beyond 10 m is what is missing.
      EXPECT_NEAR(numeric[c] / closed[c], 1, 0.002) << preset.name << " channel " << c;
    }
  }
}

TEST(Dipole, AgreesWithTheIndependentTable) {
  const std::string path = std::string(DIAPHANE_SOURCE_DIR) + "/../shared/reference/closed_form_reflectance.json";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << path << " is not there: the independent table cannot be compared";
  const nlohmann::json table = nlohmann::json::parse(file)["materials"];
  int compared = 0;
  for (const auto& [title, row] : table.items()) {
    if (title.find("not measured") != std::string::npos) continue;
    std::string name;
    for (char letter : title) {
      if (std::isalnum(static_cast<unsigned char>(letter))) name += static_cast<char>(std::tolower(letter));
    }
    const auto preset = find_preset(name);
    ASSERT_TRUE(preset.has_value()) << name;
    const glm::vec3 closed = total_reflectance(preset->coefficients);
    const Dipole dipole = make_dipole(preset->coefficients);
    for (int c = 0; c < 3; ++c) {
      const auto& channel = row[std::string(1, "RGB"[c])];
      EXPECT_NEAR(closed[c] / channel["Rd_total_closed_form"].get<double>(), 1, 0.01) << name << c;
      EXPECT_NEAR(diffuse_reflectance(dipole, 0)[c] / channel["Rd_at_r0_per_mm2"].get<double>(), 1, 0.01) << name << c;
      EXPECT_NEAR(dipole.virtual_height_mm[c] / channel["z_v_mm"].get<double>(), 1, 0.01) << name << c;
    }
    EXPECT_NEAR(diffuse_fresnel_reflectance(preset->coefficients.refractive_index) / row["Fdr_rational"].get<double>(),
                1, 0.01);
    ++compared;
  }
  EXPECT_EQ(compared, 12);
}

TEST(Fresnel, LeavesWhatTheSchoolbookLeaves) {
  EXPECT_NEAR(fresnel_transmittance(1.5f, 1), 0.96f, 1e-6f);
  EXPECT_NEAR(fresnel_transmittance(1.5f, 0), 0, 1e-6f);
  EXPECT_NEAR(fresnel_transmittance(1, 0.3f), 1, 1e-6f);
}

TEST(Fresnel, DiffuseReflectanceIsZeroWithoutABoundary) { EXPECT_EQ(diffuse_fresnel_reflectance(1), 0); }

}  // namespace
}  // namespace diaphane::optics

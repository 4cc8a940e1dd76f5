#include "render/slab_correction.h"

#include <gtest/gtest.h>

#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tests/support/lit_slab.h"
#include "tests/support/meshes.h"
#include "tests/support/random_walk.h"

namespace diaphane::render {
namespace {

TEST(ThicknessField, IsTheDiameterOfATorussTube) {
  const testing::Mesh torus = testing::make_torus(7, 2, 160, 64);
  ThicknessField field;
  field.update(torus.triangles, {.positions_mm = torus.positions_mm, .normals = torus.normals});
  const auto opposites = field.find(torus.positions_mm, torus.normals);
  ASSERT_EQ(opposites.size(), ThicknessField::kRays * torus.positions_mm.size());
  for (size_t v = 0; v < torus.positions_mm.size(); ++v) {
    const OppositePoint& along = opposites[ThicknessField::kRays * v];
    EXPECT_NEAR(along.thickness_mm, 4, 0.04) << v;
    EXPECT_GT(along.facing, 0.99f) << v;
    const glm::vec3 there = along.of(torus.triangles, torus.positions_mm);
    EXPECT_LT(glm::length(there - (torus.positions_mm[v] - 4.0f * torus.normals[v])), 0.05f) << v;
  }
}

TEST(ThicknessField, IsThePlatesAlongEveryRay) {
  const testing::Mesh plate = testing::make_box({20, 20, 1}, 2);
  ThicknessField field;
  field.update(plate.triangles, {.positions_mm = plate.positions_mm, .normals = plate.normals});
  const glm::vec3 point(0.3f, 0.4f, 0.5f), normal(0, 0, 1);
  for (const OppositePoint& opposite : field.find(std::span(&point, 1), std::span(&normal, 1))) {
    EXPECT_NEAR(opposite.thickness_mm, 1, 1e-4);
    EXPECT_NEAR(opposite.facing, 1, 1e-4);
  }
}

/// At one point, along the normal.
OppositePoint opposite_of(const ThicknessField& field, const glm::vec3& point, const glm::vec3& normal) {
  return field.find(std::span(&point, 1), std::span(&normal, 1)).front();
}

TEST(ThicknessField, FollowsTheMeshAndItsMirrorImage) {
  testing::Mesh box = testing::make_box({4, 6, 8}, 2);
  ThicknessField field;
  geometry::PlacedShape shape{.positions_mm = box.positions_mm, .normals = box.normals};
  field.update(box.triangles, shape);
  EXPECT_NEAR(opposite_of(field, {2, 0.1f, 0.2f}, {1, 0, 0}).thickness_mm, 4, 1e-4);
  for (glm::vec3& p : shape.positions_mm) p.x *= -0.5f;
  shape.flipped = true;
  field.update(box.triangles, shape);
  EXPECT_NEAR(opposite_of(field, {1, 0.1f, 0.2f}, {1, 0, 0}).thickness_mm, 2, 1e-4);
}

TEST(ThicknessField, IsInfiniteWhereNothingLiesBehind) {
  const testing::Mesh disc = testing::make_graded_disc(0.1f, 5, 16);
  ThicknessField field;
  field.update(disc.triangles, {.positions_mm = disc.positions_mm, .normals = disc.normals});
  const OppositePoint opposite = opposite_of(field, disc.positions_mm[0], disc.normals[0]);
  EXPECT_EQ(opposite.thickness_mm, std::numeric_limits<float>::infinity());
  const SlabGains gains(optics::find_preset("marble")->coefficients);
  const optics::SlabGain gain = gains.at(opposite.thickness_mm);
  EXPECT_EQ(gain.own, gains.half_space());
  EXPECT_EQ(gain.opposite, glm::vec3(0));
}

TEST(SlabGains, AreThoseOfTheFormula) {
  const optics::Coefficients material = optics::find_preset("skin1")->coefficients;
  const SlabGains gains(material);
  const optics::Slab slab(material);
  for (const float thickness : {0.05f, 0.4f, 1.1f, 7.0f, 90.0f}) {
    const optics::SlabGain exact = slab.gain(thickness), looked_up = gains.at(thickness);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(looked_up.own[c], exact.own[c], 1e-3f) << thickness;
      EXPECT_NEAR(looked_up.opposite[c], exact.opposite[c], 1e-3f) << thickness;
    }
  }
}

TEST(SlabCorrection, GivesOnAMeshWhatARandomWalkDoesFromHalfAMeanFreePathUp) {
  for (const optics::Profile profile :
       {optics::Profile::kDipole, optics::Profile::kBetterDipole, optics::Profile::kNormalizedDiffusion}) {
    // Of one mean free path a channel, so that one slab tells three albedos.
    const optics::Coefficients material{.absorption_mm = {0.001f, 0.01f, 0.32f},
                                        .reduced_scattering_mm = {0.999f, 0.99f, 0.68f},
                                        .refractive_index = 1.3f,
                                        .profile = profile};
    for (const float thickness : {0.5f, 1.0f, 3.0f}) {
      const testing::LitSlab slab = testing::light_slab(material, thickness);
      for (int c = 0; c < 3; ++c) {
        const auto walked =
            testing::walk_slab(material.reduced_scattering_mm[c], material.refractive_index, thickness, 40000);
        const double right = walked.reflected + walked.transmitted;
        EXPECT_NEAR((slab.corrected.reflected[c] + slab.corrected.transmitted[c]) / right, 1, 0.05)
            << "profile " << static_cast<int>(profile) << " thickness " << thickness << " channel " << c;
        if (thickness <= 1 && c < 2) {
          EXPECT_GT(slab.integral.reflected[c] + slab.integral.transmitted[c], 1.5 * right) << thickness;
        }
      }
    }
  }
}

}  // namespace
}  // namespace diaphane::render

#include "geometry/morph.h"

#include <gmock/gmock.h>

#include "glm/geometric.hpp"

namespace diaphane::geometry {
namespace {

using ::testing::ElementsAre;

const std::vector<glm::vec3> kRest{{-1, 0, 0}, {3, 0, 0}, {1, 1, 0}, {1, 0, 0}};

TEST(Morph, AddsOfEachTargetItsShare) {
  const MorphTargets targets{2,
                             {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 2, 0}, {0, 0, 4}, {0, 0, 4}, {0, 0, 0}, {0, 0, 0}}};
  EXPECT_THAT(morphed(kRest, targets, std::vector<float>{0.5f, -1}),
              ElementsAre(glm::vec3(-0.5f, 0, -4), glm::vec3(3, 0, -4), glm::vec3(1, 1, 0), glm::vec3(1, 1, 0)));
  EXPECT_EQ(morphed(kRest, targets, std::vector<float>{0, 0}), kRest);
}

TEST(Morph, EndsOnTheBoundingSphereAndBeginsAtRest) {
  EXPECT_EQ(morphed_to_sphere(kRest, 0), kRest);
  // The middle of the bounds is (1, 0.5, 0); the farthest points lie √4.25 from it.
  const glm::vec3 centre(1, 0.5f, 0);
  const float radius = std::sqrt(4.25f);
  const auto sphere = morphed_to_sphere(kRest, 1);
  for (const glm::vec3& p : sphere) EXPECT_NEAR(glm::distance(p, centre), radius, 1e-5);
  const auto half = morphed_to_sphere(kRest, 0.5f);
  for (size_t i = 0; i < kRest.size(); ++i) {
    EXPECT_NEAR(glm::distance(half[i], 0.5f * (kRest[i] + sphere[i])), 0, 1e-5);
  }
}

TEST(Morph, LeavesWhatLiesInTheMiddle) {
  const std::vector<glm::vec3> rest{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(morphed_to_sphere(rest, 1)[2], glm::vec3(0));
}

}  // namespace
}  // namespace diaphane::geometry

#include "client/src/quantize.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "absl/status/statusor.h"

namespace diaphane::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

absl::StatusOr<std::vector<uint16_t>> steps_of(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest,
                                               size_t width) {
  if (absl::Status held = check_in_box(values, lowest, highest); !held.ok()) return held;
  std::vector<uint16_t> steps(width * values.size(), 0xabcd);
  steps_in_box(values, lowest, highest, width, steps.data());
  return steps;
}

std::string refusal(const Vec3& value, const Vec3& lowest, const Vec3& highest) {
  return std::string(steps_of({&value, 1}, lowest, highest, 3).status().message());
}

TEST(StepsInBox, MeetTheEndsAndRoundBetween) {
  const std::vector<Vec3> values = {{-3, 0, 7}, {5, 1, 7}, {1, 1.4f / 65535, 7}, {1, 1.6f / 65535, 7}};
  EXPECT_THAT(*steps_of(values, {-3, 0, 7}, {5, 1, 7}, 3),
              ElementsAre(0, 0, 0, 65535, 65535, 0, 32768, 1, 0, 32768, 2, 0));
  EXPECT_THAT(*steps_of({&values[1], 1}, {-3, 0, 7}, {5, 1, 7}, 4), ElementsAre(65535, 65535, 0, 0));
}

TEST(StepsInBox, AreNearestToAHundredth) {
  const Vec3 lowest{-1000, -0.5f, 3}, highest{-990, 0.25f, 1e6f};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<Vec3> values(1001);
  for (Vec3& v : values) v = {-1000 + 10 * share(random), -0.5f + 0.75f * share(random), 3 + 9.9e5f * share(random)};
  for (const size_t width : {3, 4}) {
    const std::vector<uint16_t> steps = *steps_of(values, lowest, highest, width);
    for (size_t i = 0; i < values.size(); ++i) {
      const auto error = [&](size_t axis, double value, double low, double high) {
        return std::abs((value - low) / (high - low) * 65535 - steps[width * i + axis]);
      };
      EXPECT_LE(error(0, values[i].x, lowest.x, highest.x), 0.51);
      EXPECT_LE(error(1, values[i].y, lowest.y, highest.y), 0.51);
      EXPECT_LE(error(2, values[i].z, lowest.z, highest.z), 0.51);
      if (width == 4) {
        EXPECT_EQ(steps[4 * i + 3], 0);
      }
    }
  }
}

TEST(StepsInBox, RefuseWhatTheBoxDoesNotHold) {
  EXPECT_THAT(refusal({0, 2, 0}, {0, 0, 0}, {1, 1, 1}),
              HasSubstr("positions[0]: must be within (0, 0, 0) and (1, 1, 1), got (0, 2, 0)"));
  std::vector<Vec3> values(10, Vec3{0, 0, 0});
  values[6].z = -1;
  EXPECT_THAT(std::string(steps_of(values, {0, 0, 0}, {1, 1, 1}, 3).status().message()),
              HasSubstr("positions[6]: must be within (0, 0, 0) and (1, 1, 1), got (0, 0, -1)"));
  EXPECT_THAT(refusal({0, 0, NAN}, {0, 0, 0}, {1, 1, 1}), HasSubstr("got (0, 0, nan)"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, 0}, {1, -1, 1}), HasSubstr("highest: must be finite and at least lowest"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, 0}, {INFINITY, 1, 1}), HasSubstr("highest: must be finite"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, NAN}, {1, 1, 1}), HasSubstr("highest: must be finite"));
}

}  // namespace
}  // namespace diaphane::internal

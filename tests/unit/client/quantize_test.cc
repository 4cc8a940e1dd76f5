#include "client/src/quantize.h"

#include <gmock/gmock.h>

#include <cmath>

namespace diaphane::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const Vec3& value, const Vec3& lowest, const Vec3& highest) {
  return std::string(steps_in_box({&value, 1}, lowest, highest, 3).status().message());
}

TEST(StepsInBox, MeetTheEndsAndRoundBetween) {
  const std::vector<Vec3> values = {{-3, 0, 7}, {5, 1, 7}, {1, 1.4f / 65535, 7}, {1, 1.6f / 65535, 7}};
  EXPECT_THAT(*steps_in_box(values, {-3, 0, 7}, {5, 1, 7}, 3),
              ElementsAre(0, 0, 0, 65535, 65535, 0, 32768, 1, 0, 32768, 2, 0));
  EXPECT_THAT(*steps_in_box({&values[1], 1}, {-3, 0, 7}, {5, 1, 7}, 4), ElementsAre(65535, 65535, 0, 0));
}

TEST(StepsInBox, RefuseWhatTheBoxDoesNotHold) {
  EXPECT_THAT(refusal({0, 2, 0}, {0, 0, 0}, {1, 1, 1}),
              HasSubstr("positions[0]: must be within (0, 0, 0) and (1, 1, 1), got (0, 2, 0)"));
  EXPECT_THAT(refusal({0, 0, NAN}, {0, 0, 0}, {1, 1, 1}), HasSubstr("got (0, 0, nan)"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, 0}, {1, -1, 1}), HasSubstr("highest: must be finite and at least lowest"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, 0}, {INFINITY, 1, 1}), HasSubstr("highest: must be finite"));
  EXPECT_THAT(refusal({0, 0, 0}, {0, 0, NAN}, {1, 1, 1}), HasSubstr("highest: must be finite"));
}

}  // namespace
}  // namespace diaphane::internal

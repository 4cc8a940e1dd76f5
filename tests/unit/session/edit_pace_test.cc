#include "session/edit_pace.h"

#include <gtest/gtest.h>

namespace diaphane::session {
namespace {

constexpr absl::Duration kSmall = absl::Microseconds(20), kLarge = absl::Milliseconds(1);
const absl::Time kStart = absl::FromUnixSeconds(1000);

/// How many edits of `work` each are taken in a second by a client that always has another.
int edits_in_a_second(absl::Duration work) {
  EditPace pace;
  int edits = 0;
  for (absl::Time now = kStart; now < kStart + absl::Seconds(1); ++edits) now = pace.after(work, now + work, true);
  return edits;
}

TEST(EditPaceTest, LeavesEditsAloneThatComeAsFramesDo) {
  EditPace pace;
  absl::Time now = kStart;
  for (int i = 0; i < 100; ++i) {
    now += absl::Milliseconds(16);
    EXPECT_EQ(pace.after(kLarge, now, true), now);
  }
}

TEST(EditPaceTest, TakesAnEighthOfTheTimeOfAFlood) {
  EXPECT_NEAR(edits_in_a_second(kLarge), 1000 / (8 * 1.1), 3);
  EXPECT_NEAR(edits_in_a_second(kSmall), 1000 / (8 * 0.12), 20);
}

TEST(EditPaceTest, WaitsForSmallEditsOnceTheyAreMany) {
  EditPace pace;
  EXPECT_EQ(pace.after(kSmall, kStart, true), kStart);
  EXPECT_EQ(pace.after(kSmall, kStart + kSmall, true), kStart + kSmall);
  EXPECT_GT(pace.after(kSmall, kStart + 2 * kSmall, true), kStart + absl::Milliseconds(1));
  // Nothing of it is left after a while.
  const absl::Time later = kStart + absl::Seconds(1);
  EXPECT_EQ(pace.after(kSmall, later, true), later);
}

TEST(EditPaceTest, HoldsNothingBackWhileNothingIsDrawnNorForItLater) {
  EditPace pace;
  absl::Time now = kStart;
  for (int i = 0; i < 10'000; ++i) {
    now += kLarge;
    EXPECT_EQ(pace.after(kLarge, now, false), now);
  }
  EXPECT_EQ(pace.after(kLarge, now + kLarge, true), now + kLarge);
}

TEST(EditPaceTest, HoldsNoneBackForLong) {
  EditPace pace;
  absl::Time now = kStart;
  for (int i = 0; i < 10; ++i) {
    const absl::Time next = pace.after(absl::Hours(1), now, true);
    EXPECT_LE(next, now + absl::Milliseconds(250));
    now = next;
  }
}

}  // namespace
}  // namespace diaphane::session

#include "session/frame_pace.h"

#include <gtest/gtest.h>

namespace diaphane::session {
namespace {

/// A viewer whose frames take `work_ms` of the renderer at full size and quality, and what their pixels do.
class Viewer {
 public:
  explicit Viewer(const PaceAim& aim) { pace_.set_aim(aim); }

  struct Seen {
    render::FrameRequest request{};
    encode::Encoding encoding{};
    bool reduced = false;
    double interval_ms = 0;
  };

  /// `count` frames of a scene that always moves; the last.
  Seen watch(int count, double work_ms, double bytes_at_full = 1e5) {
    Seen seen;
    for (int i = 0; i < count; ++i) {
      now_ = std::max(now_, pace_.next_start());
      const absl::Time began = now_;
      pace_.began(now_);
      seen = {.encoding = {.format = encode::ImageFormat::kJpeg}};
      seen.reduced = pace_.reduce(seen.request, seen.encoding);
      const double pixels = seen.request.width_px * seen.request.height_px / (1280.0 * 720);
      const bool draft = seen.request.settings.quality == diffusion::Quality::kDraft;
      const double took_ms = work_ms * (draft ? 0.7 : 1) * (0.2 + 0.8 * pixels);
      const auto bytes = static_cast<size_t>(bytes_at_full * pixels * seen.encoding.quality / 90.0);
      now_ += absl::Milliseconds(took_ms);
      pace_.moved({began, now_, took_ms, bytes});
      pace_.sent(now_, bytes);
      seen.interval_ms = absl::ToDoubleMilliseconds(now_ - last_);
      last_ = now_;
    }
    return seen;
  }

 private:
  FramePace pace_;
  absl::Time now_ = absl::UnixEpoch(), last_ = absl::UnixEpoch();
};

TEST(FramePace, LeavesFramesAloneWithoutAnAim) {
  Viewer viewer({});
  EXPECT_FALSE(viewer.watch(50, 500, 1e7).reduced);
}

TEST(FramePace, LeavesFramesThatComeInTimeAsTheyWere) {
  Viewer viewer({.frames_per_second = 30});
  const auto seen = viewer.watch(100, 20);
  EXPECT_FALSE(seen.reduced);
  EXPECT_NEAR(seen.interval_ms, 1000 / 30.0, 1);
}

TEST(FramePace, MakesLateFramesCheaperUntilTheyComeInTime) {
  Viewer viewer({.frames_per_second = 30});
  const auto seen = viewer.watch(100, 90);
  EXPECT_TRUE(seen.reduced);
  EXPECT_EQ(seen.request.settings.quality, diffusion::Quality::kDraft);
  EXPECT_LT(seen.request.width_px, 1280u);
  EXPECT_LT(seen.interval_ms, 1.1 * 1000 / 30);
}

TEST(FramePace, TakesQualityBeforeSize) {
  Viewer viewer({.frames_per_second = 30});
  const auto seen = viewer.watch(60, 42);
  EXPECT_EQ(seen.request.settings.quality, diffusion::Quality::kDraft);
  EXPECT_EQ(seen.request.width_px, 1280u);
}

TEST(FramePace, GoesNoLowerThanAQuarterASide) {
  Viewer viewer({.frames_per_second = 240});
  const auto seen = viewer.watch(400, 5000);
  EXPECT_EQ(seen.request.width_px, 320u);
  EXPECT_EQ(seen.request.height_px, 180u);
}

TEST(FramePace, ComesBackWhenThereIsRoom) {
  Viewer viewer({.frames_per_second = 30});
  EXPECT_TRUE(viewer.watch(100, 90).reduced);
  EXPECT_FALSE(viewer.watch(300, 15).reduced);
}

TEST(FramePace, HoldsBytesByQualityFirstAndNeverExceedsThem) {
  Viewer viewer({.frames_per_second = 30, .bytes_per_second = 2e6});
  const auto some = viewer.watch(200, 5);
  EXPECT_LT(some.encoding.quality, 90);
  EXPECT_EQ(some.request.width_px, 1280u);
  EXPECT_NEAR(some.interval_ms, 1000 / 30.0, 2);
  Viewer poor({.frames_per_second = 30, .bytes_per_second = 3e5});
  const auto least = poor.watch(200, 5);
  EXPECT_EQ(least.encoding.quality, FramePace::kLowestQuality);
  EXPECT_LT(least.request.width_px, 1280u);
  EXPECT_LT(1000 / least.interval_ms * 1e5 * least.request.width_px * least.request.height_px / (1280 * 720.0) / 3,
            3.3e5);
}

TEST(FramePace, BeginsAnewWithAnotherAimAndOnlyThen) {
  FramePace pace;
  pace.set_aim({.frames_per_second = 10});
  pace.began(absl::UnixEpoch());
  pace.set_aim({.frames_per_second = 10});
  EXPECT_EQ(pace.next_start(), absl::UnixEpoch() + absl::Milliseconds(100));
  pace.set_aim({});
  EXPECT_LT(pace.next_start(), absl::UnixEpoch());
}

TEST(FramePace, DoesNotMakeGoodAnIdleTime) {
  FramePace pace;
  pace.set_aim({.frames_per_second = 10});
  pace.began(absl::UnixEpoch());
  const absl::Time later = absl::UnixEpoch() + absl::Seconds(5);
  pace.began(later);
  EXPECT_EQ(pace.next_start(), later + absl::Milliseconds(100));
}

}  // namespace
}  // namespace diaphane::session

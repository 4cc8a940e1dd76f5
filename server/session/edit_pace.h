// How soon the next edit is taken.
#pragma once

#include <algorithm>

#include "absl/time/time.h"

namespace diaphane::session {

/// Keeps a stream of edits to an eighth of a core's time while frames are drawn: those that come faster than frames are
/// passed over by whoever watches, and cost the renderer what they take. One thread at a time.
class EditPace {
 public:
  /// An edit took `work`, until `now`. When to take the next: `now`, unless frames are drawn and the edits before it
  /// came too soon after each other.
  absl::Time after(absl::Duration work, absl::Time now, bool frames_are_drawn) {
    if (!frames_are_drawn) {
      paid_at_ = absl::InfinitePast();
      return now;
    }
    // One by itself sets no alarm, which would take time of the frame that shows it.
    const absl::Time due = std::max(paid_at_, now - work);
    paid_at_ = std::min(due + kTimes * (work + kMessage), now + kLongest);
    return due - now < kShortest ? now : due;
  }

 private:
  static constexpr int kTimes = 8;
  // What gRPC takes of both sides for an edit and the word that it is applied.
  static constexpr absl::Duration kMessage = absl::Microseconds(100);
  // Timers know no shorter one; small edits save it up.
  static constexpr absl::Duration kShortest = absl::Milliseconds(1);
  // However large an edit is, and whatever the clock does.
  static constexpr absl::Duration kLongest = absl::Milliseconds(250);

  absl::Time paid_at_ = absl::InfinitePast();  ///< when what was taken is an eighth of the time since
};

}  // namespace diaphane::session

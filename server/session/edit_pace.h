// How soon the next edit is taken.
#pragma once

#include <algorithm>

#include "absl/time/time.h"

namespace diaphane::session {

/// Keeps a stream of edits to an eighth of a core's time: those that come faster than frames are drawn are passed over
/// by whoever watches, and cost the renderer what they take. One thread at a time.
class EditPace {
 public:
  /// An edit took `work`, until `now`. When to take the next: `now`, unless those before it came too soon after each
  /// other.
  absl::Time after(absl::Duration work, absl::Time now) {
    // One by itself sets no alarm, which would take time of the frame that shows it.
    const absl::Time due = std::max(paid_at_, now - work);
    paid_at_ = due + kTimes * (work + kMessage);
    return due - now < kShortest ? now : due;
  }

 private:
  static constexpr int kTimes = 8;
  // What gRPC takes of both sides for an edit and the word that it is applied.
  static constexpr absl::Duration kMessage = absl::Microseconds(100);
  // Timers know no shorter one; small edits save it up.
  static constexpr absl::Duration kShortest = absl::Milliseconds(1);

  absl::Time paid_at_ = absl::InfinitePast();  ///< when what was taken is an eighth of the time since
};

}  // namespace diaphane::session

// How large and how fine frames are while a scene moves, so that a rate and a bandwidth hold.
#pragma once

#include <cstddef>
#include <cstdint>

#include "absl/time/time.h"
#include "encode/encode.h"
#include "render/frame.h"

namespace diaphane::session {

/// What is to hold while a scene moves; 0: whatever comes.
struct PaceAim {
  double frames_per_second = 0;
  double bytes_per_second = 0;
  bool operator==(const PaceAim&) const = default;
};

/// Steers the frames of one viewer by what the last ones took. For time the integral's quality goes first, then the
/// size; for bytes the quality of JPEG and WebP, then the size, or the bitrate of H.264. Down when frames come late or
/// large; up again once there is room for the next step, later each time that there turned out to be none. No clock of
/// its own, one thread at a time.
class FramePace {
 public:
  static constexpr double kSmallestScale = 0.25;
  static constexpr int kLowestQuality = 30;

  /// Begins anew where `aim` is another.
  void set_aim(const PaceAim& aim);

  /// Nothing is to begin before: the rate is not passed, nor the bandwidth over more than a quarter of a second.
  absl::Time next_start() const;

  /// Of a frame that begins now.
  void began(absl::Time now);

  /// Makes a moving frame cheaper, so far as it has to be. Whether it differs from what was asked.
  bool reduce(render::FrameRequest& request, encode::Encoding& encoding) const;

  struct Moved {
    absl::Time began;    ///< asked for
    absl::Time ended;    ///< encoded
    double work_ms = 0;  ///< of the render thread
    size_t bytes = 0;
  };
  /// A moving frame that reduce() made.
  void moved(const Moved& frame);

  /// Bytes of any frame, as they are sent.
  void sent(absl::Time now, size_t bytes);

 private:
  /// A ladder of steps: 0 is what was asked for.
  class Ladder {
   public:
    explicit Ladder(int lowest) : lowest_(lowest) {}
    int step() const { return step_; }
    /// `load`: what frames take over what they may; `rise`: over that, one step up.
    void see(double load, double rise);

   private:
    int lowest_;
    int step_ = 0;
    int quiet_ = 0;      // frames since a step
    int patience_ = 8;   // frames before a step up
    double load_ = 0;    // smoothed
    bool rose_ = false;  // the last step was up
  };

  PaceAim aim_;
  Ladder time_{10};
  Ladder size_{15};
  absl::Time next_start_ = absl::InfinitePast();
  absl::Time last_ended_ = absl::InfinitePast();
  absl::Time paid_until_ = absl::InfinitePast();  // when what was sent is through, at the bandwidth
};

}  // namespace diaphane::session

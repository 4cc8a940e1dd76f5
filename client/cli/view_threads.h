// What runs beside the keys of diaphane view.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "absl/status/status.h"
#include "animator.h"
#include "diaphane/stream.h"
#include "terminal.h"
#include "terminal_picture.h"

namespace diaphane::cli {

/// How it ended: the first thing that went wrong. Thread-safe.
class Outcome {
 public:
  void end(const absl::Status& status);
  bool ended() const { return ended_; }
  absl::Status status() const;

 private:
  mutable std::mutex mutex_;
  absl::Status status_;
  std::atomic<bool> ended_{false};
};

/// Draws frames as they come, on a thread of its own. What it is given must live as long; `outcome` hears of the end.
class Screen {
 public:
  Screen(FrameStream& stream, Terminal& terminal, PictureProtocol protocol, Outcome& outcome);
  /// Closes the stream.
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  absl::Status run();
  absl::Status draw(const StreamedFrame& frame);
  std::string last_row(const StreamedFrame& frame, const TerminalExtent& extent);

  FrameStream& stream_;
  Terminal& terminal_;
  const PictureProtocol protocol_;
  std::optional<TerminalExtent> drawn_;  ///< what the last picture filled
  Clock::time_point before_ = Clock::now();
  double frames_per_second_ = 0;
  std::thread thread_;
};

/// Sends edits in their time, over and over, on a thread of its own. What it is given must live as long; `outcome`
/// hears of errors.
class Mover {
 public:
  Mover(Animator& animator, double edits_per_second, Outcome& outcome);
  ~Mover();
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  void pause_or_go_on() { paused_ = !paused_; }

 private:
  using Clock = std::chrono::steady_clock;

  absl::Status run();

  Animator& animator_;
  const Clock::duration between_;
  std::atomic<bool> paused_{false}, stopped_{false};
  std::thread thread_;
};

}  // namespace diaphane::cli

// What each stage of a frame cost.
#pragma once

#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "render/frame.h"

namespace diaphane::render {

/// Adds up the time of a frame's stages, in the order in which they were first named. One thread.
class StageClock {
 public:
  StageClock() = default;
  /// Keeps its list in the memory of `spare`.
  explicit StageClock(std::vector<StageTime> spare) : stages_(std::move(spare)) { stages_.clear(); }

  /// Runs `work` and books its time on `stage`.
  template <typename Work>
  auto run(std::string_view stage, Work&& work) {
    const auto begin = std::chrono::steady_clock::now();
    struct Booking {
      StageClock* clock;
      std::string_view stage;
      std::chrono::steady_clock::time_point begin;
      ~Booking() {
        StageTime& entry = clock->entry(stage);
        entry.ran = true;
        entry.milliseconds +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
      }
    } booking{this, stage, begin};
    return std::forward<Work>(work)();
  }

  /// Names a stage that had nothing to do.
  void sleep(std::string_view stage) { entry(stage); }

  std::vector<StageTime> take() { return std::move(stages_); }

 private:
  StageTime& entry(std::string_view stage) {
    for (StageTime& known : stages_) {
      if (known.stage == stage) return known;
    }
    return stages_.emplace_back(StageTime{std::string(stage), 0, false});
  }

  std::vector<StageTime> stages_;
};

}  // namespace diaphane::render

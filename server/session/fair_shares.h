// Whose turn it is.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <string>

namespace diaphane::session {

/// Gives those who wait equal shares of a renderer's time: start-time fair queueing (Goyal, Vin, Cheng 1996). Who did
/// not ask for a while has next to nothing saved up. One thread at a time.
class FairShares {
 public:
  /// Which of those that wait, in order of arrival and at least one, is served now.
  size_t choose(std::span<const std::string* const> waiting) {
    size_t chosen = 0;
    double earliest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < waiting.size(); ++i) {
      const auto found = ends_.find(*waiting[i]);
      const double begin = found == ends_.end() ? now_ : std::max(found->second, now_ - kMostSaved_ms);
      if (begin < earliest) {
        earliest = begin;
        chosen = i;
      }
    }
    begin_ = earliest;
    now_ = std::max(now_, earliest);
    // But not of the one that is booked next, whose entry is used again.
    std::erase_if(ends_, [&](const auto& entry) {
      return entry.second <= now_ - kMostSaved_ms && entry.first != *waiting[chosen];
    });
    return chosen;
  }

  /// The one that was chosen last, and is called that, took so long.
  void book(const std::string& name, double milliseconds) { ends_[name] = begin_ + milliseconds; }

 private:
  // Who is a little late with asking, a frame's way to its viewer, loses no turn by it.
  static constexpr double kMostSaved_ms = 50;

  double now_ = 0;                      ///< virtual time: the latest at which one that was served began
  double begin_ = 0;                    ///< when the one that is served did
  std::map<std::string, double> ends_;  ///< when their last service ended, where that is to come
};

}  // namespace diaphane::session

// Whose turn it is.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <string>

namespace diaphane::session {

/// Gives those who wait equal shares of a renderer's time: start-time fair queueing (Goyal, Vin, Cheng 1996). Who did
/// not ask for a while has nothing saved up. One thread at a time.
class FairShares {
 public:
  /// Which of those that wait, in order of arrival and at least one, is served now.
  size_t choose(std::span<const std::string* const> waiting) {
    size_t chosen = 0;
    double earliest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < waiting.size(); ++i) {
      const auto found = ends_.find(*waiting[i]);
      const double begin = std::max(found == ends_.end() ? 0.0 : found->second, now_);
      if (begin < earliest) {
        earliest = begin;
        chosen = i;
      }
    }
    now_ = earliest;
    // But not of the one that is booked next, whose entry is used again.
    std::erase_if(ends_, [&](const auto& entry) { return entry.second <= now_ && entry.first != *waiting[chosen]; });
    return chosen;
  }

  /// The one that was chosen last, and is called that, took so long.
  void book(const std::string& name, double milliseconds) { ends_[name] = now_ + milliseconds; }

 private:
  double now_ = 0;                      ///< virtual time: when the one that is served began
  std::map<std::string, double> ends_;  ///< when their last service ended, where that is to come
};

}  // namespace diaphane::session

// How a stage knows that it may sleep.
#pragma once

#include <optional>

namespace diaphane::render {

/// Remembers what a stage last read. One thread.
template <typename Key>
class Memo {
 public:
  /// Whether `key` differs from the last one; remembers it, in the memory of the last.
  bool renew(const Key& key) {
    if (last_.has_value() && *last_ == key) return false;
    last_ = key;
    return true;
  }
  void forget() { last_.reset(); }

 private:
  std::optional<Key> last_;
};

}  // namespace diaphane::render

// What is going on, for somebody who watches.
#pragma once

#include <string_view>

namespace diaphane::cli {

/// One line on stderr that is replaced at each step, and gone at the end; nothing where stderr is no terminal.
class Progress {
 public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { clear(); }

  void step(std::string_view what);
  /// A step with a bar, `share` of which is done, 0..1.
  void bar(std::string_view what, double share);
  void clear();

 private:
  void show(std::string_view line);

  bool terminal_;
  bool shown_ = false;
};

}  // namespace diaphane::cli

#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "fmt/format.h"

namespace diaphane::cli {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::step(std::string_view what) { show(fmt::format("{} ...", what)); }

void Progress::bar(std::string_view what, double share) {
  constexpr int kCells = 30;
  const int done = static_cast<int>(kCells * std::clamp(share, 0.0, 1.0));
  show(fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %", what, "", done, "", kCells - done, 100 * share));
}

void Progress::show(std::string_view line) {
  if (!terminal_) return;
  clear();
  fmt::print(stderr, "{}", line);
  std::fflush(stderr);
  shown_ = true;
}

void Progress::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace diaphane::cli

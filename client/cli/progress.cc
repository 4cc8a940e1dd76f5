#include "progress.h"

#include <unistd.h>

#include <cstdio>

#include "fmt/format.h"

namespace diaphane::cli {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::step(std::string_view what) {
  if (!terminal_) return;
  clear();
  fmt::print(stderr, "{} ...", what);
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

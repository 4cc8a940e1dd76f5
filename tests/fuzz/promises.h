// How a fuzz target says that something must hold.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace diaphane::fuzz {

/// Aborts, which is what a fuzzer takes for a finding, unless it `holds`.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

}  // namespace diaphane::fuzz

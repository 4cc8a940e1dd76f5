// Numbers that name the state of something.
#pragma once

#include <cstdint>

namespace diaphane::render {

/// A number that no call gave before: two states that share one are the same. Thread-safe.
uint64_t next_generation();

}  // namespace diaphane::render

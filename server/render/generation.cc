#include "render/generation.h"

#include <atomic>

namespace diaphane::render {

uint64_t next_generation() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

}  // namespace diaphane::render

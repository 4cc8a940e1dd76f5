// What operator new is asked for, thread by thread. A program that links this has its operators replaced.
#pragma once

#include <atomic>
#include <cstddef>

namespace diaphane {

/// From here on each allocation by this thread adds one to `counter`; null: none does.
void count_allocations_of_this_thread(std::atomic<size_t>* counter);

}  // namespace diaphane

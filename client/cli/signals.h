// Ctrl-C: stop in order.
#pragma once

#include <stop_token>

namespace diaphane::cli {

/// Takes SIGINT, SIGTERM and SIGHUP over for the whole process: the first one requests the stop, a second one ends the
/// process at once. Call once from main, before any other thread is there.
std::stop_token stop_on_signals();

/// Ends the process by the signal that was caught, as the shell expects it; returns if there was none.
void end_by_caught_signal();

}  // namespace diaphane::cli

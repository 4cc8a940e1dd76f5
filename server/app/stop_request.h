// How a process is asked to end.
#pragma once

#include <string>

namespace diaphane::app {

/// Blocks SIGTERM and SIGINT for this thread and those that it starts, and ignores SIGPIPE. First thing in main, so
/// that no thread of a library is killed by a signal that wait_for_stop() should see.
void block_stop_signals();

/// Waits for SIGTERM or SIGINT, or with `watch_stdin` for the end of standard input. Returns what came, for the log.
/// A second SIGINT then kills the process. Main thread only.
std::string wait_for_stop(bool watch_stdin);

}  // namespace diaphane::app

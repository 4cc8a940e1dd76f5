// The commands and their options, and which one runs.
#pragma once

#include <stop_token>

#include "status.h"

namespace diaphane::cli {

/// Parses, runs, and prints an error, if there is one, as one line on stderr.
ExitCode run_command_line(int argc, const char* const* argv, std::stop_token stop);

}  // namespace diaphane::cli

// The command line.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "CLI/CLI.hpp"
#include "command_line.h"
#include "signals.h"
#include "status.h"

int main(int argc, char** argv) {
  using namespace diaphane::cli;
  setenv("GRPC_VERBOSITY", "NONE", 0);  // every error is one line, and it is ours
  try {
    const ExitCode code = run_command_line(argc, argv, stop_on_signals());
    end_by_caught_signal();
    return code;
  } catch (const std::exception& error) {
    print_note(error.what());
    return kExitFile;
  }
}

// diaphane sequence
#pragma once

#include <string>

#include "absl/status/status.h"
#include "global_options.h"
#include "sequence_arguments.h"

namespace diaphane::cli {

/// Makes every frame of a motion that is not there yet, into a folder, or for a movie into a folder beside it until the
/// movie is whole. `job`: job_options(). Prints the output's path, or with --json what was made, on stdout.
absl::Status run_sequence(const GlobalOptions& global, const SequenceArguments& arguments, const std::string& job);

}  // namespace diaphane::cli

// diaphane stream
#pragma once

#include "absl/status/status.h"
#include "global_options.h"
#include "stream_arguments.h"

namespace diaphane::cli {

/// Deforms a scene on a server in real time, and keeps the frames that come of it. Says on stderr how fast they came,
/// or with --json on stdout.
absl::Status run_stream(const GlobalOptions& global, const StreamArguments& arguments);

}  // namespace diaphane::cli

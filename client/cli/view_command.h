// diaphane view: a scene in the terminal.
#pragma once

#include "absl/status/status.h"
#include "global_options.h"
#include "view_arguments.h"

namespace diaphane::cli {

/// Shows it, turned by keys, until q or Ctrl-C. Errors: as of the stream command; kExitUsage where there is no
/// terminal.
absl::Status run_view(const GlobalOptions& global, const ViewArguments& arguments);

}  // namespace diaphane::cli

// diaphane render
#pragma once

#include "absl/status/status.h"
#include "global_options.h"
#include "render_arguments.h"

namespace diaphane::cli {

/// Reads the files, has a server make the frame, and writes it. The scene that it made for that is deleted again,
/// whatever happens. Prints the image's path, or with --json what was made, on stdout.
absl::Status run_render(const GlobalOptions& global, const RenderArguments& arguments);

}  // namespace diaphane::cli

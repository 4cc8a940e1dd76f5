// diaphane materials, info, health and scene: what a server knows.
#pragma once

#include <string>

#include "absl/status/status.h"
#include "global_options.h"

namespace diaphane::cli {

/// Print on stdout, as a table or as JSON.
absl::Status run_materials(const GlobalOptions& global);
absl::Status run_info(const GlobalOptions& global);

/// These need a running server: a private one serves, and has no scenes. `scene` is scenes/{scene} or {scene}.
absl::Status run_health(const GlobalOptions& global);
absl::Status run_scene_ls(const GlobalOptions& global);
absl::Status run_scene_show(const GlobalOptions& global, const std::string& scene);
absl::Status run_scene_rm(const GlobalOptions& global, const std::string& scene);

}  // namespace diaphane::cli

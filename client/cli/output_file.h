// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "absl/status/status.h"

namespace diaphane::cli {

/// OK when write_file is likely to succeed: the folder is there, and what is at `path`, if anything, is a regular file.
/// Errors: kExitFile.
absl::Status check_writable(const std::filesystem::path& path);

/// Writes a temporary file beside `path` and renames it. Errors: kExitFile; `path` is as it was.
absl::Status write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace diaphane::cli

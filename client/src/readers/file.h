// Whole files into memory, bounded.
#pragma once

#include <string>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// The bytes of the regular file at `path`. Errors, in the name of `source`: kNotFound, kPermissionDenied,
/// kInvalidArgument when it is no regular file, kResourceExhausted past `max_bytes` (nothing was allocated then).
absl::StatusOr<std::string> read_whole_file(const std::filesystem::path& path, uint64_t max_bytes,
                                            const Source& source);

}  // namespace diaphane::readers

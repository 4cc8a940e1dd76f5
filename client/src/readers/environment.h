// Maps of light from bytes.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "diaphane/environment.h"
#include "readers/source.h"

namespace diaphane::readers {

inline constexpr uint32_t kLargestMapWidth_px = 8192;
inline constexpr uint32_t kLargestMapHeight_px = 4096;

/// Whether `bytes` begin like a file of the kind.
bool is_radiance(std::string_view bytes);
bool is_openexr(std::string_view bytes);

/// As read_environment_file().
absl::StatusOr<EnvironmentMap> read_radiance(std::string_view bytes, const Source& source);
absl::StatusOr<EnvironmentMap> read_openexr(std::string_view bytes, const Source& source);

/// OK for a size that a map may have.
absl::Status check_map_size(int64_t width_px, int64_t height_px, const Source& source);

}  // namespace diaphane::readers

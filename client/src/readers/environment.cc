#include "readers/environment.h"

#include "fmt/format.h"
#include "readers/file.h"

namespace diaphane::readers {

absl::Status check_map_size(int64_t width_px, int64_t height_px, const Source& source) {
  if (width_px < 2 || height_px < 1) {
    return source.malformed(fmt::format("a size of {}x{}", width_px, height_px), "header", "must be at least 2x1");
  }
  if (width_px <= kLargestMapWidth_px && height_px <= kLargestMapHeight_px) return absl::OkStatus();
  return source.error(absl::StatusCode::kResourceExhausted, fmt::format("a size of {}x{}", width_px, height_px),
                      "header", fmt::format("must be at most {}x{}", kLargestMapWidth_px, kLargestMapHeight_px));
}

}  // namespace diaphane::readers

namespace diaphane {

absl::StatusOr<EnvironmentMap> read_environment_file(const std::filesystem::path& path) {
  readers::Source source;
  source.name = path.string();
  const absl::StatusOr<std::string> bytes = readers::read_whole_file(path, source.limits.max_file_bytes, source);
  if (!bytes.ok()) return bytes.status();
  if (readers::is_radiance(*bytes)) return readers::read_radiance(*bytes, source);
  if (readers::is_openexr(*bytes)) return readers::read_openexr(*bytes, source);
  return source.malformed("is neither a Radiance picture (.hdr) nor OpenEXR (.exr)");
}

}  // namespace diaphane

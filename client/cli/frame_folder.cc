#include "frame_folder.h"

#include <fstream>
#include <iterator>
#include <system_error>

#include "fmt/format.h"
#include "output_file.h"
#include "status.h"

namespace diaphane::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJobFile = "sequence.json";

}  // namespace

absl::StatusOr<FrameFolder> FrameFolder::open(const fs::path& folder, std::string_view extension,
                                              std::string_view job) {
  std::error_code code;
  fs::create_directory(folder, code);
  if (code || !fs::is_directory(folder)) {
    const std::string why = code ? code.message() : "not a folder";
    return with_exit_code(absl::InternalError(fmt::format("{}: {}", folder.string(), why)), kExitFile);
  }
  const fs::path job_file = folder / kJobFile;
  if (std::ifstream there(job_file, std::ios::binary); there) {
    const std::string text{std::istreambuf_iterator<char>(there), {}};
    if (text == job) return FrameFolder(folder, extension);
    return usage_error(
        "-o", fmt::format("{} holds another sequence (see its {}); give another folder", folder.string(), kJobFile));
  }
  if (absl::Status status = write_file(job_file, job); !status.ok()) return status;
  return FrameFolder(folder, extension);
}

fs::path FrameFolder::path_of(uint32_t frame) const {
  return folder_ / fmt::format("frame_{:05}{}", frame, extension_);
}

bool FrameFolder::has(uint32_t frame) const {
  std::error_code code;
  return fs::is_regular_file(path_of(frame), code);
}

absl::Status FrameFolder::write(uint32_t frame, std::string_view bytes) const {
  return write_file(path_of(frame), bytes);
}

void FrameFolder::remove(uint32_t frames) const {
  std::error_code code;
  for (uint32_t frame = 0; frame < frames; ++frame) fs::remove(path_of(frame), code);
  fs::remove(folder_ / kJobFile, code);
  fs::remove(folder_, code);  // which fails where something else is in it
}

}  // namespace diaphane::cli

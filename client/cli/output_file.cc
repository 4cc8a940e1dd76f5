#include "output_file.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "fmt/format.h"
#include "status.h"

namespace diaphane::cli {
namespace {

namespace fs = std::filesystem;

absl::Status file_error(const fs::path& path, std::string_view what) {
  return with_exit_code(absl::InternalError(fmt::format("{}: {}", path.string(), what)), kExitFile);
}

absl::Status system_error(const fs::path& path, int code) {
  return file_error(path, std::generic_category().message(code));
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// Errno of what went wrong, or 0.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) bytes.remove_prefix(static_cast<size_t>(count));
  }
  return 0;
}

}  // namespace

absl::Status check_writable(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::exists(status) && !fs::is_regular_file(status)) return file_error(path, "not a regular file");
  const fs::path folder = folder_of(path);
  if (!fs::is_directory(folder, code)) return file_error(path, fmt::format("{}: no such folder", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) return system_error(path, errno);
  return absl::OkStatus();
}

absl::Status write_file(const fs::path& path, std::string_view bytes) {
  std::string temporary = (folder_of(path) / fmt::format(".{}.XXXXXX", path.filename().string())).string();
  const int file = mkstemp(temporary.data());
  if (file < 0) return system_error(path, errno);
  const mode_t mask = umask(0);
  umask(mask);
  int error = write_all(file, bytes);
  if (error == 0 && fchmod(file, 0666 & ~mask) != 0) error = errno;
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return absl::OkStatus();
  unlink(temporary.c_str());
  return system_error(path, error);
}

}  // namespace diaphane::cli

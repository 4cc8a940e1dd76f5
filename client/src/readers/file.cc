#include "readers/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

class Descriptor {
 public:
  // Non-blocking, so that a pipe in the place of a file cannot hold the caller up before it is refused.
  explicit Descriptor(const std::filesystem::path& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

absl::Status open_error(int error, const Source& source) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return source.error(absl::StatusCode::kNotFound, "no such file");
    case EACCES:
    case EPERM:
      return source.error(absl::StatusCode::kPermissionDenied, "cannot be opened: permission denied");
    default:
      return source.malformed(fmt::format("cannot be opened: {}", std::strerror(error)));
  }
}

}  // namespace

absl::StatusOr<std::string> read_whole_file(const std::filesystem::path& path, uint64_t max_bytes,
                                            const Source& source) {
  const Descriptor file(path);
  if (file.get() < 0) return open_error(errno, source);
  struct stat status;
  if (fstat(file.get(), &status) != 0) return open_error(errno, source);
  if (!S_ISREG(status.st_mode)) return source.malformed("is not a regular file");
  const uint64_t size = static_cast<uint64_t>(status.st_size);
  if (size > max_bytes) return source.over_limit("bytes", size, max_bytes);

  std::string bytes(size, '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = read(file.get(), bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return source.error(absl::StatusCode::kUnavailable, fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace diaphane::readers

#include "base/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::base {
namespace {

absl::Status refused(const char* call) {
  return absl::ResourceExhaustedError(fmt::format("{}: {}", call, std::generic_category().message(errno)));
}

}  // namespace

absl::StatusOr<SharedMemory> SharedMemory::create(size_t size) {
  // Linux would look for more than there is page by page, until it kills someone.
  if (size > kMostBytes) {
    return field_error(absl::StatusCode::kResourceExhausted,
                       {"size", fmt::format("{}", size), fmt::format("at most {} bytes", kMostBytes)});
  }
  std::string nonce(kNonceBytes, '\0');
  if (getrandom(nonce.data(), nonce.size(), 0) != static_cast<ssize_t>(nonce.size())) return refused("getrandom");
  const int file = memfd_create("diaphane-edits", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file < 0) return refused("memfd_create");
  absl::Cleanup close_file = [file] { close(file); };
  if (fchmod(file, S_IRUSR | S_IWUSR) != 0) return refused("fchmod");
  // Of a file that became shorter, reading its end would be the death of the reader.
  if (fallocate(file, 0, 0, static_cast<off_t>(size)) != 0) return refused("fallocate");
  if (fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) return refused("fcntl");
  if (pwrite(file, nonce.data(), nonce.size(), 0) != static_cast<ssize_t>(nonce.size())) return refused("pwrite");
  void* const mapped = mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED) return refused("mmap");
  std::move(close_file).Cancel();
  return SharedMemory(file, {static_cast<const char*>(mapped), size}, std::move(nonce));
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_descriptor_(std::exchange(other.file_descriptor_, -1)),
      bytes_(std::exchange(other.bytes_, {})),
      nonce_(std::move(other.nonce_)) {}

SharedMemory::~SharedMemory() {
  if (file_descriptor_ < 0) return;
  munmap(const_cast<char*>(bytes_.data()), bytes_.size());
  close(file_descriptor_);
}

}  // namespace diaphane::base

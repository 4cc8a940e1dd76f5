#include "payload_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "fmt/format.h"

namespace diaphane::internal {
namespace {

constexpr std::string_view kFileName = "/memfd:diaphane-edits";
constexpr size_t kNonceBytes = 16;
// Of payloads: a cache line's.
constexpr size_t kAlignment = 64;

size_t aligned(size_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

/// Whether it has the size, and can never have less: writing beyond a file's end would be the death of the writer.
bool is_sealed(int file, uint64_t size) {
  struct stat status {};
  const int seals = fcntl(file, F_GET_SEALS);
  return seals >= 0 && (seals & F_SEAL_SHRINK) != 0 && fstat(file, &status) == 0 &&
         static_cast<uint64_t>(status.st_size) == size;
}

}  // namespace

PayloadPtr PayloadPool::take(size_t count) {
  std::unique_ptr<std::string> bytes;
  {
    const std::lock_guard lock(spare_->mutex);
    bytes = std::move(spare_->bytes);
  }
  if (bytes == nullptr) bytes = std::make_unique<std::string>();
  bytes->resize(count);
  // gRPC may be the last to let go, on a thread of its own.
  const std::shared_ptr<std::string> owner(bytes.release(), [spare = spare_](std::string* used) {
    const std::lock_guard lock(spare->mutex);
    spare->bytes.reset(used);
  });
  return std::make_shared<PayloadBytes>(PayloadBytes{*owner, owner});
}

std::shared_ptr<SharedMemory> SharedMemory::open(const v1::SharedMemory& offer) {
  const std::string path = fmt::format("/proc/{}/fd/{}", offer.process_id(), offer.file_descriptor());
  // Looked at before it is opened: to open some devices is to do something.
  std::error_code code;
  if (!std::filesystem::read_symlink(path, code).native().starts_with(kFileName)) return nullptr;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return nullptr;
  void* mapped = MAP_FAILED;
  if (offer.bytes() > kNonceBytes && is_sealed(file, offer.bytes())) {
    mapped = mmap(nullptr, offer.bytes(), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  }
  close(file);
  if (mapped == MAP_FAILED) return nullptr;
  std::shared_ptr<SharedMemory> memory(
      new SharedMemory(offer.id(), {static_cast<char*>(mapped), static_cast<size_t>(offer.bytes())}));
  const bool is_the_servers = std::string_view(memory->bytes_.data(), kNonceBytes) == offer.nonce();
  return is_the_servers ? memory : nullptr;
}

SharedMemory::~SharedMemory() { munmap(bytes_.data(), bytes_.size()); }

PayloadPtr SharedMemory::take(size_t count) {
  const std::lock_guard lock(mutex_);
  size_t begin = aligned(kNonceBytes);
  auto next = used_.begin();
  for (; next != used_.end() && (next->begin < begin || next->begin - begin < count); ++next)
    begin = aligned(next->end);
  if (begin > bytes_.size() || count > bytes_.size() - begin) return nullptr;
  used_.insert(next, Range{begin, begin + count});
  const std::shared_ptr<const void> owner(nullptr, [self = shared_from_this(), begin](const void*) {
    const std::lock_guard unused(self->mutex_);
    std::erase_if(self->used_, [&](const Range& range) { return range.begin == begin; });
  });
  return std::make_shared<PayloadBytes>(PayloadBytes{bytes_.subspan(begin, count), owner, this, begin});
}

}  // namespace diaphane::internal

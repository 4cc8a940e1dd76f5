#include "service/shared_buffers.h"

#include <unistd.h>

#include <array>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::service {
namespace {

constexpr uint64_t kMostBytes = uint64_t{64} << 20;  // of a stream
constexpr size_t kMostBuffers = 8;                   // of a stream
constexpr int kMostOfAll = 128;
constexpr uint64_t kAlignment = 4;  // of floats

}  // namespace

bool is_on_this_machine(std::string_view peer) {
  // gRPC writes an IPv6 address as a URI has it.
  constexpr std::array<std::string_view, 4> kLocal = {"unix:", "ipv4:127.", "ipv6:%5B::1%5D:", "ipv6:[::1]:"};
  for (const std::string_view local : kLocal) {
    if (peer.starts_with(local)) return true;
  }
  return false;
}

bool SharedBufferCount::add() {
  if (++count_ <= kMostOfAll) return true;
  --count_;
  return false;
}

absl::StatusOr<std::optional<v1::SharedMemory>> SharedBuffers::share(uint64_t bytes) {
  if (bytes == 0 || bytes > kMostBytes) {
    return base::invalid_field("shared_memory_bytes", fmt::format("1..{}", kMostBytes), fmt::format("{}", bytes));
  }
  const uint64_t size = bytes + base::SharedMemory::kNonceBytes;
  if (!is_on_this_machine_ || bytes > kMostBytes - bytes_ || buffers_.size() >= kMostBuffers) return std::nullopt;
  absl::StatusOr<scene::Reservation> reservation = store_.reserve(size);
  if (!reservation.ok() || !count_.add()) return std::nullopt;
  absl::StatusOr<base::SharedMemory> memory = base::SharedMemory::create(size);
  if (!memory.ok()) {
    count_.remove(1);
    return std::nullopt;
  }
  const Buffer& buffer = buffers_.emplace_back(Buffer{*std::move(reservation), *std::move(memory)});
  bytes_ += bytes;
  v1::SharedMemory offer;
  offer.set_id(static_cast<uint32_t>(buffers_.size() - 1));
  offer.set_process_id(getpid());
  offer.set_file_descriptor(buffer.memory.file_descriptor());
  offer.set_bytes(size);
  offer.set_nonce(buffer.memory.nonce());
  return offer;
}

absl::StatusOr<std::string_view> SharedBuffers::find(const v1::SharedBytes& named) const {
  if (named.memory() >= buffers_.size()) {
    return base::invalid_field("shared.memory", fmt::format("one of {} that are shared", buffers_.size()),
                               fmt::format("{}", named.memory()));
  }
  const std::span<const char> bytes = buffers_[named.memory()].memory.bytes();
  if (named.offset() > bytes.size() || named.offset() % kAlignment != 0) {
    return base::invalid_field("shared.offset", fmt::format("0..{}, a multiple of {}", bytes.size(), kAlignment),
                               fmt::format("{}", named.offset()));
  }
  if (named.bytes() > bytes.size() - named.offset()) {
    return base::invalid_field("shared.bytes",
                               fmt::format("at most {} from {} on", bytes.size() - named.offset(), named.offset()),
                               fmt::format("{}", named.bytes()));
  }
  return std::string_view(bytes.data() + named.offset(), named.bytes());
}

}  // namespace diaphane::service

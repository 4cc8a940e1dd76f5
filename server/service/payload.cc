#include "service/payload.h"

#include <cstring>
#include <new>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::service {

absl::StatusOr<Payload> Payload::create(PayloadSpec spec) {
  std::unique_ptr<char[]> bytes(new (std::nothrow) char[spec.total_bytes]);
  if (bytes == nullptr) return absl::ResourceExhaustedError("out of memory");
  return Payload(std::move(spec), std::move(bytes));
}

absl::Status Payload::append(std::string_view chunk, uint32_t max_chunk_bytes) {
  if (chunk.size() > max_chunk_bytes) {
    return base::invalid_field("chunk", fmt::format("at most {} bytes", max_chunk_bytes),
                               fmt::format("{} bytes", chunk.size()));
  }
  const uint64_t missing = spec_.total_bytes - received_;
  if (chunk.size() > missing) {
    return base::invalid_field("chunk", fmt::format("at most the {} bytes that are missing", missing),
                               fmt::format("{} bytes", chunk.size()));
  }
  std::memcpy(bytes_.get() + received_, chunk.data(), chunk.size());
  received_ += chunk.size();
  hash_.update(chunk);
  return absl::OkStatus();
}

absl::Status Payload::check_complete() {
  if (received_ != spec_.total_bytes) {
    return base::invalid_field("chunk", fmt::format("{} bytes in all", spec_.total_bytes),
                               fmt::format("{} bytes", received_));
  }
  const std::string hash = hash_.finish();
  if (hash == spec_.sha256) return absl::OkStatus();
  return base::invalid_field("sha256", fmt::format("the payload's, {}", hex(hash)), hex(spec_.sha256));
}

}  // namespace diaphane::service

// The bytes of an upload, as they come in.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"
#include "service/convert/upload.h"
#include "service/sha256.h"

namespace diaphane::service {

/// One thread at a time.
class Payload {
 public:
  /// Memory for `spec.total_bytes`, which the caller has reserved. RESOURCE_EXHAUSTED when the machine has it not.
  static absl::StatusOr<Payload> create(PayloadSpec spec);

  /// INVALID_ARGUMENT for a chunk over `max_chunk_bytes`, or past the total.
  absl::Status append(std::string_view chunk, uint32_t max_chunk_bytes);

  /// INVALID_ARGUMENT when bytes are missing, or their hash is not the header's. Once, and last.
  absl::Status check_complete();

  const PayloadSpec& spec() const { return spec_; }
  std::span<const char> bytes() const { return {bytes_.get(), received_}; }

 private:
  Payload(PayloadSpec spec, std::unique_ptr<char[]> bytes) : spec_(std::move(spec)), bytes_(std::move(bytes)) {}

  PayloadSpec spec_;
  std::unique_ptr<char[]> bytes_;
  uint64_t received_ = 0;
  Sha256 hash_;
};

}  // namespace diaphane::service

// The bytes of an upload, without a copy of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diaphane/values.h"

namespace diaphane::internal {

inline constexpr size_t kChunkBytes = size_t{1} << 20;

/// Arrays one after the other, as the contract's payloads are: little-endian, no padding. Borrows what it is given.
class Payload {
 public:
  void append(std::span<const Vec3> values) { append_bytes(std::as_bytes(values)); }
  void append(std::span<const Rgb> values) { append_bytes(std::as_bytes(values)); }
  void append(std::span<const TextureCoordinate> values) { append_bytes(std::as_bytes(values)); }
  void append(std::span<const uint8_t> values) { append_bytes(std::as_bytes(values)); }
  void append(std::span<const uint32_t> values) { append_bytes(std::as_bytes(values)); }

  uint64_t total_bytes() const { return total_bytes_; }

  /// SHA-256 of all bytes, 32 of them.
  std::string sha256() const;

  /// Calls `take` with each chunk in turn: kChunkBytes each, the last one shorter, none empty. Stops, and returns
  /// false, once `take` returns false.
  bool for_each_chunk(const std::function<bool(std::string)>& take) const;

 private:
  void append_bytes(std::span<const std::byte> bytes);

  std::vector<std::span<const std::byte>> parts_;
  uint64_t total_bytes_ = 0;
};

}  // namespace diaphane::internal

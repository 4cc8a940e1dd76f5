// Memory that other processes write and this one reads.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "absl/status/statusor.h"

namespace diaphane::base {

/// A file in memory. Whoever may open its descriptor under /proc, this process's user alone, may write it at any time,
/// so a reader copies first and checks the copy; nobody can make it shorter, or longer. Linux. Thread-safe.
class SharedMemory {
 public:
  static constexpr size_t kNonceBytes = 16;
  static constexpr size_t kMostBytes = size_t{1} << 30;

  /// `size` bytes, more than a nonce's: zeros but for the nonce at the beginning, and all there from the start, so that
  /// no later write fails for want of memory. RESOURCE_EXHAUSTED beyond kMostBytes, and where the machine has it not,
  /// or not this kind.
  static absl::StatusOr<SharedMemory> create(size_t size);

  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory();

  std::span<const char> bytes() const { return bytes_; }
  int file_descriptor() const { return file_descriptor_; }
  const std::string& nonce() const { return nonce_; }

 private:
  SharedMemory(int file_descriptor, std::span<const char> bytes, std::string nonce)
      : file_descriptor_(file_descriptor), bytes_(bytes), nonce_(std::move(nonce)) {}

  int file_descriptor_;
  std::span<const char> bytes_;
  std::string nonce_;
};

}  // namespace diaphane::base

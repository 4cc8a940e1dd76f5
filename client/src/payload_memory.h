// Memory for the bytes that follow an edit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "diaphane/v1/scene_service.pb.h"

namespace diaphane::internal {

class SharedMemory;

/// Bytes of a payload. They do not change once they are written to a call.
struct PayloadBytes {
  std::span<char> bytes;
  std::shared_ptr<const void> owner{};   ///< gives them back
  const SharedMemory* shared = nullptr;  ///< not null: what they lie in
  uint64_t offset = 0;                   ///< in it
};
using PayloadPtr = std::shared_ptr<const PayloadBytes>;

/// Memory of this process, used again once nobody reads it any more. Thread-safe.
class PayloadPool {
 public:
  /// `count` bytes of no particular value.
  PayloadPtr take(size_t count);

 private:
  struct Spare {
    std::mutex mutex;
    std::unique_ptr<std::string> bytes;  ///< null: none
  };
  const std::shared_ptr<Spare> spare_ = std::make_shared<Spare>();
};

/// Memory that a server on this machine reads. Thread-safe.
class SharedMemory : public std::enable_shared_from_this<SharedMemory> {
 public:
  /// Null where it is not what the offer says: this is another machine, or it is another user's.
  static std::shared_ptr<SharedMemory> open(const v1::SharedMemory& offer);
  ~SharedMemory();

  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  uint32_t id() const { return id_; }

  /// `count` bytes that no other payload has; null while there is no room.
  PayloadPtr take(size_t count);

 private:
  struct Range {
    size_t begin, end;
  };

  SharedMemory(uint32_t id, std::span<char> bytes) : id_(id), bytes_(bytes) {}

  const uint32_t id_;
  const std::span<char> bytes_;
  std::mutex mutex_;
  std::vector<Range> used_;  // in order
};

}  // namespace diaphane::internal

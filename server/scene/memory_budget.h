// Bytes that meshes may take, counted before they are allocated.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "absl/status/statusor.h"

namespace diaphane::scene {

class MemoryBudget;

/// A share of a MemoryBudget, given back when it goes. Move-only; one thread at a time. May outlive its budget.
class Reservation {
 public:
  Reservation() = default;
  Reservation(Reservation&& other) noexcept : used_(std::move(other.used_)), bytes_(std::exchange(other.bytes_, 0)) {}
  Reservation& operator=(Reservation&& other) noexcept;
  ~Reservation() { shrink_to(0); }

  uint64_t bytes() const { return bytes_; }

  /// Gives back all but `bytes`; nothing when it holds fewer.
  void shrink_to(uint64_t bytes);

  /// Moves `bytes` of it, at most all, into a reservation of their own.
  Reservation split(uint64_t bytes);

 private:
  friend class MemoryBudget;
  Reservation(std::shared_ptr<std::atomic<uint64_t>> used, uint64_t bytes) : used_(std::move(used)), bytes_(bytes) {}

  std::shared_ptr<std::atomic<uint64_t>> used_;
  uint64_t bytes_ = 0;
};

/// Thread-safe.
class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t max_bytes) : max_bytes_(max_bytes) {}

  /// RESOURCE_EXHAUSTED naming mesh_bytes when `bytes` more would pass the limit.
  absl::StatusOr<Reservation> reserve(uint64_t bytes);

  uint64_t used_bytes() const { return *used_; }

 private:
  const uint64_t max_bytes_;
  std::shared_ptr<std::atomic<uint64_t>> used_ = std::make_shared<std::atomic<uint64_t>>(0);
};

/// `value`, whose last owner gives `reservation` back: memory counts for as long as anybody keeps it alive.
template <typename T>
std::shared_ptr<const T> hold(std::shared_ptr<const T> value, Reservation reservation) {
  struct Held {
    Reservation reservation;
    std::shared_ptr<const T> value;
  };
  const auto held = std::make_shared<Held>(Held{std::move(reservation), std::move(value)});
  return std::shared_ptr<const T>(held, held->value.get());
}

}  // namespace diaphane::scene

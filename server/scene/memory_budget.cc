#include "scene/memory_budget.h"

#include <algorithm>

#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::scene {

Reservation& Reservation::operator=(Reservation&& other) noexcept {
  if (this != &other) {
    shrink_to(0);
    used_ = std::move(other.used_);
    bytes_ = std::exchange(other.bytes_, 0);
  }
  return *this;
}

void Reservation::shrink_to(uint64_t bytes) {
  if (bytes >= bytes_) return;
  *used_ -= bytes_ - bytes;
  bytes_ = bytes;
}

Reservation Reservation::split(uint64_t bytes) {
  const uint64_t moved = std::min(bytes, bytes_);
  bytes_ -= moved;
  return Reservation(used_, moved);
}

absl::StatusOr<Reservation> MemoryBudget::reserve(uint64_t bytes) {
  uint64_t used = *used_;
  do {
    if (used > max_bytes_ || bytes > max_bytes_ - used) {
      return base::field_error(
          absl::StatusCode::kResourceExhausted,
          {"mesh_bytes", fmt::format("{}", bytes),
           fmt::format("at most {} (limit {}, in use {})", max_bytes_ - std::min(used, max_bytes_), max_bytes_, used)});
    }
  } while (!used_->compare_exchange_weak(used, used + bytes));
  return Reservation(used_, bytes);
}

}  // namespace diaphane::scene

#include "quantize.h"

#include <cmath>

#include "fmt/format.h"

namespace diaphane::internal {
namespace {

constexpr double kSteps = 65535;

std::string text(const Vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

/// One axis of the box.
class Axis {
 public:
  Axis(float low, float high) : low_(low), high_(high), scale_(high > low ? kSteps / (high_ - low_) : 0) {}

  // Written so that NaN fails too.
  bool is_one() const { return high_ >= low_ && std::isfinite(high_ - low_); }
  bool holds(float value) const { return value >= low_ && value <= high_; }
  uint16_t step(float value) const { return static_cast<uint16_t>((value - low_) * scale_ + 0.5); }

 private:
  double low_, high_, scale_;
};

}  // namespace

absl::StatusOr<std::vector<uint16_t>> steps_in_box(std::span<const Vec3> values, const Vec3& lowest,
                                                   const Vec3& highest, size_t width) {
  const Axis x(lowest.x, highest.x), y(lowest.y, highest.y), z(lowest.z, highest.z);
  if (!x.is_one() || !y.is_one() || !z.is_one()) {
    return absl::InvalidArgumentError(
        fmt::format("highest: must be finite and at least lowest, {}, got {}", text(lowest), text(highest)));
  }
  std::vector<uint16_t> steps(width * values.size());
  uint16_t* next = steps.data();
  for (size_t i = 0; i < values.size(); ++i, next += width) {
    const Vec3& v = values[i];
    if (!x.holds(v.x) || !y.holds(v.y) || !z.holds(v.z)) {
      return absl::InvalidArgumentError(
          fmt::format("positions[{}]: must be within {} and {}, got {}", i, text(lowest), text(highest), text(v)));
    }
    next[0] = x.step(v.x);
    next[1] = y.step(v.y);
    next[2] = z.step(v.z);
  }
  return steps;
}

}  // namespace diaphane::internal

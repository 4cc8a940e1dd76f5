#include "quantize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "fmt/format.h"

namespace diaphane::internal {
namespace {

constexpr float kSteps = 65535;

std::string text(const Vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

// What the compilers that build this make vector instructions of.
using Four = float __attribute__((vector_size(16)));
using FourInts = int32_t __attribute__((vector_size(16)));
using FourSigned = int16_t __attribute__((vector_size(8)));
using FourShorts = uint16_t __attribute__((vector_size(8)));

/// Four values at once: their axes, one after the other, fill three vectors.
constexpr size_t kAtOnce = 4;
using Values = std::array<Four, 3>;
using Steps = std::array<FourShorts, 3>;

Values repeated(const Vec3& v) {
  return {Four{v.x, v.y, v.z, v.x}, Four{v.y, v.z, v.x, v.y}, Four{v.z, v.x, v.y, v.z}};
}

float steps_per_unit(float low, float high) { return high > low ? kSteps / (high - low) : 0; }

class Box {
 public:
  Box(const Vec3& low, const Vec3& high)
      : lowest_(repeated(low)),
        highest_(repeated(high)),
        scale_(
            repeated({steps_per_unit(low.x, high.x), steps_per_unit(low.y, high.y), steps_per_unit(low.z, high.z)})) {}

  const Values& lowest() const { return lowest_; }

  /// `inside` becomes 0 where a value is not, NaN too.
  void look_at(const Values& values, FourInts& inside) const {
    for (size_t i = 0; i < 3; ++i) inside &= (values[i] >= lowest_[i]) & (values[i] <= highest_[i]);
  }

  /// Of values inside.
  Steps steps_of(const Values& values) const {
    Steps steps;
    for (size_t i = 0; i < 3; ++i) {
      const FourInts whole = __builtin_convertvector((values[i] - lowest_[i]) * scale_[i] + 0.5f, FourInts);
      steps[i] = (FourShorts)(__builtin_convertvector(whole - 32768, FourSigned) ^ (int16_t)(-32768));
    }
    return steps;
  }

 private:
  Values lowest_, highest_, scale_;
};

/// Written so that NaN fails too.
bool is_box(const Vec3& low, const Vec3& high) {
  const auto is_range = [](float l, float h) { return h >= l && std::isfinite(h - l); };
  return is_range(low.x, high.x) && is_range(low.y, high.y) && is_range(low.z, high.z);
}

/// Three numbers of each of `count` values as four.
void spread(const Steps& found, size_t count, uint16_t* steps) {
  const auto* from = reinterpret_cast<const char*>(found.data());
  for (size_t i = 0; i < count; ++i) {
    std::memcpy(steps + 4 * i, from + 3 * sizeof(uint16_t) * i, 3 * sizeof(uint16_t));
    steps[4 * i + 3] = 0;
  }
}

/// Of the first that the box does not hold.
absl::Status refusal(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest) {
  const auto holds = [&](const Vec3& v) {
    return v.x >= lowest.x && v.x <= highest.x && v.y >= lowest.y && v.y <= highest.y && v.z >= lowest.z &&
           v.z <= highest.z;
  };
  const auto found = std::find_if_not(values.begin(), values.end(), holds);
  return absl::InvalidArgumentError(fmt::format("positions[{}]: must be within {} and {}, got {}",
                                                found - values.begin(), text(lowest), text(highest), text(*found)));
}

/// Calls take(first, block, count) for four values at a time; of the last block, which `lowest` fills up, for fewer.
template <typename Take>
void for_each_block(std::span<const Vec3> values, const Box& box, const Take& take) {
  const size_t whole = values.size() / kAtOnce * kAtOnce;
  for (size_t first = 0; first < whole; first += kAtOnce) {
    Values block;
    std::memcpy(block.data(), &values[first], sizeof(block));
    take(first, block, kAtOnce);
  }
  if (whole == values.size()) return;
  Values block = box.lowest();
  std::memcpy(block.data(), &values[whole], (values.size() - whole) * sizeof(Vec3));
  take(whole, block, values.size() - whole);
}

}  // namespace

absl::Status check_in_box(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest) {
  if (!is_box(lowest, highest)) {
    return absl::InvalidArgumentError(
        fmt::format("highest: must be finite and at least lowest, {}, got {}", text(lowest), text(highest)));
  }
  const Box box(lowest, highest);
  // All at once first; which one is outside is asked only then.
  FourInts inside = {-1, -1, -1, -1};
  for_each_block(values, box, [&](size_t, const Values& block, size_t) { box.look_at(block, inside); });
  if ((inside[0] & inside[1] & inside[2] & inside[3]) == 0) return refusal(values, lowest, highest);
  return absl::OkStatus();
}

void steps_in_box(std::span<const Vec3> values, const Vec3& lowest, const Vec3& highest, size_t width,
                  uint16_t* steps) {
  const Box box(lowest, highest);
  for_each_block(values, box, [&](size_t first, const Values& block, size_t count) {
    const Steps found = box.steps_of(block);
    if (width == 4) return spread(found, count, steps + 4 * first);
    uint16_t* const to = steps + 3 * first;
    if (count < kAtOnce) {
      std::memcpy(to, found.data(), count * 3 * sizeof(uint16_t));
      return;
    }
    for (size_t i = 0; i < found.size(); ++i) std::memcpy(to + 4 * i, &found[i], sizeof(found[i]));
  });
}

}  // namespace diaphane::internal

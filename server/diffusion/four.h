// Four floats at once with the compiler's own vectors: the same bytes on every machine that rounds the same.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace diaphane::diffusion {

typedef float Four __attribute__((vector_size(16)));

inline Four load4(const float* from) {
  Four v;
  std::memcpy(&v, from, sizeof(v));
  return v;
}

inline void store4(float* to, Four v) { std::memcpy(to, &v, sizeof(v)); }

typedef double TwoDoubles __attribute__((vector_size(16)));

/// Three floats and a zero; reads no fourth.
inline Four load3(const float* from) {
  double low;
  std::memcpy(&low, from, sizeof(low));
  const Four high{from[2], 0, 0, 0};
  return __builtin_shufflevector(std::bit_cast<Four>(TwoDoubles{low, 0}), high, 0, 1, 4, 5);
}

/// The first three lanes; writes no fourth.
inline void store3(float* to, Four v) {
  const double low = std::bit_cast<TwoDoubles>(v)[0];
  std::memcpy(to, &low, sizeof(low));
  to[2] = v[2];
}

inline Four max4(Four a, Four b) { return a > b ? a : b; }

/// Four comparisons: lanes are 0 or −1.
typedef int32_t FourMask __attribute__((vector_size(16)));

/// Bit k is set where lane k is.
inline uint32_t bits_of(FourMask mask) {
#if defined(__SSE2__)
  Four lanes;
  std::memcpy(&lanes, &mask, sizeof(lanes));
  return static_cast<uint32_t>(__builtin_ia32_movmskps(lanes));
#else
  return (mask[0] & 1u) | (mask[1] & 2u) | (mask[2] & 4u) | (mask[3] & 8u);
#endif
}

inline Four sqrt4(Four v) {
#if defined(__SSE2__)
  return __builtin_ia32_sqrtps(v);
#else
  return Four{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

/// Rows become columns.
inline void transpose4(Four& a, Four& b, Four& c, Four& d) {
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace diaphane::diffusion

// Looking kernels up from registers, for one SIMD level.
#if defined(DIAPHANE_DIFFUSION_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DIAPHANE_DIFFUSION_KERNEL_INL_H_
#undef DIAPHANE_DIFFUSION_KERNEL_INL_H_
#else
#define DIAPHANE_DIFFUSION_KERNEL_INL_H_
#endif

#include "diffusion/kernel_table.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using IndexTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using Index = hn::Vec<IndexTag>;

/// Calls work(0), work(1), work(2) without a loop, so that what it sums up stays in registers.
template <class Work>
HWY_INLINE void for_channels(const Work& work) {
  work(0);
  work(1);
  work(2);
}

/// Lanes choose one of eight entries by their index's low three bits.
HWY_INLINE V look_up(const float* entries, Index index) {
#if HWY_TARGET == HWY_AVX2
  return V{_mm256_permutevar8x32_ps(_mm256_load_ps(entries), index.raw)};
#elif HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  const __m512 twice = _mm512_castpd_ps(_mm512_broadcast_f64x4(_mm256_castps_pd(_mm256_load_ps(entries))));
  return V{_mm512_permutexvar_ps(index.raw, twice)};
#else
  const IndexTag di;
  return hn::GatherIndex(Tag(), entries, hn::And(index, hn::Set(di, KernelTable::kSegments - 1)));
#endif
}

/// Where squared distances fall in the tables.
struct TablePosition {
  V v;         ///< clamped to the tables
  V inverse2;  ///< 1/v², not clamped: the kernel decays beyond the tables
  V inverse3;
  Index index;
};

HWY_INLINE TablePosition locate(const KernelDomain& domain, V distance2) {
  const Tag d;
  const V squared =
      hn::MulAdd(distance2, hn::Set(d, domain.scale), hn::Set(d, KernelDomain::kSmallest * KernelDomain::kSmallest));
#if HWY_ARCH_X86
  // A Newton step makes the approximation good to rounding, at a fifth of the time of a root and a quotient.
  const V guess = hn::ApproximateReciprocalSqrt(squared);
  const V residual = hn::NegMulAdd(hn::Mul(squared, guess), guess, hn::Set(d, 1.0f));
  const V inverse = hn::MulAdd(hn::Mul(guess, hn::Set(d, 0.5f)), residual, guess);
  const V root = hn::Mul(squared, inverse);
#else
  const V root = hn::Sqrt(squared);
  const V inverse = hn::Div(hn::Set(d, 1.0f), root);
#endif
  const V clamped = hn::Min(root, hn::Set(d, KernelDomain::kLargest));
  const V inverse2 = hn::Mul(inverse, inverse);
  return {clamped, inverse2, hn::Mul(inverse2, inverse), hn::ShiftRight<23>(hn::BitCast(IndexTag(), clamped))};
}

HWY_INLINE V cubic(const float (&coefficients)[KernelTable::kCoefficients][KernelTable::kSegments],
                   const TablePosition& at) {
  V sum = look_up(coefficients[3], at.index);
  sum = hn::MulAdd(sum, at.v, look_up(coefficients[2], at.index));
  sum = hn::MulAdd(sum, at.v, look_up(coefficients[1], at.index));
  return hn::MulAdd(sum, at.v, look_up(coefficients[0], at.index));
}

/// A cubic and its derivative in v.
struct CubicSlope {
  V value, slope;
};

HWY_INLINE CubicSlope cubic_slope(const float (&coefficients)[KernelTable::kCoefficients][KernelTable::kSegments],
                                  const TablePosition& at) {
  V slope = look_up(coefficients[3], at.index);
  V value = hn::MulAdd(slope, at.v, look_up(coefficients[2], at.index));
  slope = hn::MulAdd(slope, at.v, value);
  value = hn::MulAdd(value, at.v, look_up(coefficients[1], at.index));
  slope = hn::MulAdd(slope, at.v, value);
  return {hn::MulAdd(value, at.v, look_up(coefficients[0], at.index)), slope};
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

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
  V u;         ///< clamped to the tables
  V inverse;   ///< 1/u, not clamped: the kernel decays beyond the tables
  Index index;
};

HWY_INLINE TablePosition locate(const KernelDomain& domain, V distance2) {
  const Tag d;
  const V u = hn::MulAdd(distance2, hn::Set(d, domain.scale), hn::Set(d, KernelDomain::kSmallest));
  const V clamped = hn::Min(u, hn::Set(d, KernelDomain::kLargest));
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  // The approximation is exactly specified at this level; one Newton step makes it as good as a division.
  const V guess = hn::ApproximateReciprocal(u);
  const V inverse = hn::Mul(guess, hn::NegMulAdd(u, guess, hn::Set(d, 2.0f)));
#else
  const V inverse = hn::Div(hn::Set(d, 1.0f), u);
#endif
  return {clamped, inverse, hn::ShiftRight<24>(hn::BitCast(IndexTag(), clamped))};
}

HWY_INLINE V cubic(const float (&coefficients)[KernelTable::kCoefficients][KernelTable::kSegments],
                   const TablePosition& at) {
  V sum = look_up(coefficients[3], at.index);
  sum = hn::MulAdd(sum, at.u, look_up(coefficients[2], at.index));
  sum = hn::MulAdd(sum, at.u, look_up(coefficients[1], at.index));
  return hn::MulAdd(sum, at.u, look_up(coefficients[0], at.index));
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

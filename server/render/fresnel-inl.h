// Fresnel's transmittance for one SIMD level.
#if defined(DIAPHANE_RENDER_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DIAPHANE_RENDER_FRESNEL_INL_H_
#undef DIAPHANE_RENDER_FRESNEL_INL_H_
#else
#define DIAPHANE_RENDER_FRESNEL_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// 1 − R, unpolarised, at a cosine of 0..1.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> fresnel_transmittance(float refractive_index,
                                                                 hn::Vec<hn::ScalableTag<float>> cosine) {
  const hn::ScalableTag<float> d;
  const auto one = hn::Set(d, 1.0f), eta = hn::Set(d, refractive_index);
  const auto sine2 = hn::NegMulAdd(cosine, cosine, one);
  const auto inside = hn::Sqrt(
      hn::Max(hn::Zero(d), hn::NegMulAdd(sine2, hn::Set(d, 1.0f / (refractive_index * refractive_index)), one)));
  const auto bent = hn::Mul(eta, inside), steep = hn::Mul(eta, cosine);
  // One quotient for both ratios. At an index of 1 and a grazing angle there is nothing below them.
  const auto below_s = hn::Add(cosine, bent), below_p = hn::Add(inside, steep);
  const auto inverse = hn::Div(one, hn::Max(hn::Mul(below_s, below_p), hn::Set(d, 1e-30f)));
  const auto s = hn::Mul(hn::Mul(hn::Sub(cosine, bent), below_p), inverse);
  const auto p = hn::Mul(hn::Mul(hn::Sub(inside, steep), below_s), inverse);
  return hn::NegMulAdd(hn::Set(d, 0.5f), hn::MulAdd(s, s, hn::Mul(p, p)), one);
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

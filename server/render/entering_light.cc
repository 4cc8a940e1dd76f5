#include "render/entering_light.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/entering_light.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/fresnel-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using V = hn::Vec<Tag>;

template <bool kDirectional, bool kSpot>
void add_light(const LightStorage& light, float refractive_index, const SurfacePoints& points, size_t count,
               const float* seen, EnteringLight& sum) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    V x = hn::Set(d, light.position_mm.x), y = hn::Set(d, light.position_mm.y), z = hn::Set(d, light.position_mm.z);
    if constexpr (!kDirectional) {
      x = hn::Sub(x, hn::Load(d, points.x + i));
      y = hn::Sub(y, hn::Load(d, points.y + i));
      z = hn::Sub(z, hn::Load(d, points.z + i));
    }
    V cosine =
        hn::MulAdd(x, hn::Load(d, points.normal_x + i),
                   hn::MulAdd(y, hn::Load(d, points.normal_y + i), hn::Mul(z, hn::Load(d, points.normal_z + i))));
    // Neighbours mostly turn away together.
    if (hn::AllFalse(d, hn::Gt(cosine, zero))) continue;
    V share = one, inverse = one;
    if constexpr (!kDirectional) {
      const V squared = hn::Max(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))), hn::Set(d, 1e-12f));
      share = hn::Div(one, squared);
      inverse = hn::Sqrt(share);
    }
    cosine = hn::Min(hn::Max(hn::Mul(cosine, inverse), zero), one);
    if constexpr (kSpot) {
      const V along = hn::MulAdd(x, hn::Set(d, light.axis.x),
                                 hn::MulAdd(y, hn::Set(d, light.axis.y), hn::Mul(z, hn::Set(d, light.axis.z))));
      const V inwards = hn::Mul(hn::NegMulAdd(along, inverse, hn::Set(d, -light.axis.a)), hn::Set(d, light.shape.x));
      const V cone = hn::Min(hn::Max(inwards, zero), one);
      const V smooth = hn::NegMulAdd(hn::Set(d, 2.0f), cone, hn::Set(d, 3.0f));
      share = hn::Mul(share, hn::Mul(hn::Mul(cone, cone), smooth));
    }
    if (seen != nullptr) share = hn::Mul(share, hn::LoadU(d, seen + i));
    share = hn::Mul(share, hn::Mul(cosine, fresnel_transmittance(refractive_index, cosine)));
    for (int c = 0; c < 3; ++c) {
      float* to = sum.channel[c] + i;
      hn::Store(hn::MulAdd(share, hn::Set(d, light.power[c]), hn::Load(d, to)), d, to);
    }
  }
}

void dispatch_light(const LightStorage& light, float refractive_index, const SurfacePoints& points, size_t count,
                    const float* seen, EnteringLight& sum) {
  const bool spot = light.axis.a >= -1;
  const auto add = light.power.a != 0 ? add_light<true, false>
                   : spot             ? add_light<false, true>
                                      : add_light<false, false>;
  add(light, refractive_index, points, count, seen, sum);
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(dispatch_light);

void add_entering_light(const LightStorage& light, float refractive_index, const SurfacePoints& points, size_t count,
                        const float* seen, EnteringLight& sum) {
  HWY_DYNAMIC_DISPATCH(dispatch_light)(light, refractive_index, points, count, seen, sum);
}

}  // namespace diaphane::render
#endif

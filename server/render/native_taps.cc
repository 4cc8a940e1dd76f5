#include "render/native_taps.h"

#include <algorithm>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/native_taps.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "hwy/contrib/math/math-inl.h"
#include "diffusion/kernel-inl.h"
#include "render/fresnel-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using IndexTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using Index = hn::Vec<IndexTag>;
using Mask = hn::Mask<Tag>;

constexpr size_t kMostLanes = 16;
constexpr int kMostTaps = 6;
constexpr int kTexel = NativeCube::kFloatsPerTexel;

/// One of three by the axis that a lane looks along.
struct AxisChoice {
  Mask is_x, is_y;
  HWY_INLINE V pick(V x, V y, V z) const { return hn::IfThenElse(is_x, x, hn::IfThenElse(is_y, y, z)); }
};

/// A vector of points as faces see them.
struct PointsOnFaces {
  V face;            ///< as a whole number
  V u, v;            ///< in texels, centres at whole numbers
  V depth;           ///< mm over the box's centre
  V u_step, v_step;  ///< texels a mm
  V product;         ///< N·f; 0: no face shows the point
};

/// As agrees() of shared/atlas_lookup.glsl.
HWY_INLINE Mask agrees(const NativeCube& cube, const PointsOnFaces& at, V n_u, V n_v, V n_w, V facet_sine) {
  const Tag d;
  const IndexTag di;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V last = hn::Set(d, static_cast<float>(cube.size_px() - 1));
  const V texel_mm = hn::Div(one, hn::Min(at.u_step, at.v_step));
  const V tolerance_mm = hn::Div(hn::Mul(hn::Add(hn::Set(d, 0.2f), facet_sine), texel_mm), hn::Sqrt(hn::Abs(n_w)));
  const V left = hn::Floor(at.u), low = hn::Floor(at.v);
  const V right = hn::Sub(at.u, left), above = hn::Sub(at.v, low);
  // P from the centre, along u, v and the axis.
  const V middle = hn::Set(d, 0.5f * static_cast<float>(cube.size_px()) - 0.5f);
  const V p_u = hn::Div(hn::Sub(at.u, middle), at.u_step), p_v = hn::Div(hn::Sub(at.v, middle), at.v_step);
  V agreeing = zero;
  for (int corner = 0; corner < 4; ++corner) {
    const bool to_right = (corner & 1) != 0, upper = (corner & 2) != 0;
    const V x = hn::Min(hn::Max(to_right ? hn::Add(left, one) : left, zero), last);
    const V y = hn::Min(hn::Max(upper ? hn::Add(low, one) : low, zero), last);
    const Index texel =
        hn::Add(hn::Mul(hn::ConvertTo(di, at.face), hn::Set(di, cube.face_texels())),
                hn::Add(hn::Mul(hn::Add(hn::ConvertTo(di, y), hn::Set(di, 1)), hn::Set(di, cube.row_texels())),
                        hn::Add(hn::ConvertTo(di, x), hn::Set(di, 1))));
    const Index place = hn::ShiftLeft<3>(texel);
    static_assert(kTexel == 8);
    const auto field = [&](int f) HWY_ATTR { return hn::GatherIndex(d, cube.texels() + f, place); };
    const V key = field(3), along_u = field(4), along_v = field(5), coverage = field(7);
    const V rest2 = hn::NegMulAdd(along_u, along_u, hn::NegMulAdd(along_v, along_v, one));
    // The stored normal looks at the face, as the point's own does.
    const V towards = hn::CopySign(hn::Sqrt(hn::Max(zero, rest2)), n_w);
    const V turn = hn::MulAdd(along_u, n_u, hn::MulAdd(along_v, n_v, hn::Mul(towards, n_w)));
    const V plane = hn::MulAdd(along_u, p_u, hn::MulAdd(along_v, p_v, hn::Mul(towards, at.depth)));
    const Mask same = hn::And(hn::And(hn::Gt(coverage, zero), hn::Gt(turn, hn::Set(d, 0.5f))),
                              hn::Lt(hn::Abs(hn::Sub(plane, key)), tolerance_mm));
    const V weight = hn::Mul(to_right ? right : hn::Sub(one, right), upper ? above : hn::Sub(one, above));
    agreeing = hn::Add(agreeing, hn::IfThenElseZero(same, weight));
  }
  return hn::Gt(agreeing, hn::Set(d, 0.25f));
}

/// The first face by N·f that shows each of a vector of points.
HWY_INLINE PointsOnFaces choose_faces(const NativeCube& cube, const PointBatch& points, size_t i) {
  const Tag d;
  const BoxUniforms& box = cube.box();
  const V zero = hn::Zero(d);
  const V size = hn::Set(d, static_cast<float>(cube.size_px()));
  const V x = hn::Sub(hn::Load(d, points.surface.x + i), hn::Set(d, box.centre_mm.x));
  const V y = hn::Sub(hn::Load(d, points.surface.y + i), hn::Set(d, box.centre_mm.y));
  const V z = hn::Sub(hn::Load(d, points.surface.z + i), hn::Set(d, box.centre_mm.z));
  const V n_x = hn::Load(d, points.surface.normal_x + i), n_y = hn::Load(d, points.surface.normal_y + i);
  const V n_z = hn::Load(d, points.surface.normal_z + i);
  const V facet_sine = hn::Load(d, points.facet_sine + i);
  V product_x = hn::Abs(n_x), product_y = hn::Abs(n_y), product_z = hn::Abs(n_z);
  const V taken = hn::Set(d, -1.0f);
  PointsOnFaces chosen{zero, zero, zero, zero, hn::Set(d, 1.0f), hn::Set(d, 1.0f), zero};
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Mask is_x = hn::And(hn::Ge(product_x, product_y), hn::Ge(product_x, product_z));
    const Mask is_y = hn::AndNot(is_x, hn::Ge(product_y, product_z));
    const AxisChoice axis{is_x, is_y};
    const V product = axis.pick(product_x, product_y, product_z);
    const Mask asks = hn::And(hn::Eq(chosen.product, zero), hn::Gt(product, hn::Set(d, 0.05f)));
    if (hn::AllFalse(d, asks)) break;
    const V n_w = axis.pick(n_x, n_y, n_z);
    const auto texels_per_mm = [&](int a) HWY_ATTR {
      return hn::Set(d, static_cast<float>(cube.size_px()) / box.extent_mm[a]);
    };
    PointsOnFaces at;
    at.u_step = axis.pick(texels_per_mm(1), texels_per_mm(2), texels_per_mm(0));
    at.v_step = axis.pick(texels_per_mm(2), texels_per_mm(0), texels_per_mm(1));
    const V middle = hn::MulAdd(size, hn::Set(d, 0.5f), hn::Set(d, -0.5f));
    at.u = hn::MulAdd(axis.pick(y, z, x), at.u_step, middle);
    at.v = hn::MulAdd(axis.pick(z, x, y), at.v_step, middle);
    at.depth = axis.pick(x, y, z);
    at.product = product;
    at.face = hn::Add(axis.pick(zero, hn::Set(d, 2.0f), hn::Set(d, 4.0f)),
                      hn::IfThenElseZero(hn::Lt(n_w, zero), hn::Set(d, 1.0f)));
    const Mask found =
        hn::And(asks, agrees(cube, at, axis.pick(n_y, n_z, n_x), axis.pick(n_z, n_x, n_y), n_w, facet_sine));
    const auto keep = [&](V& to, V from) HWY_ATTR { to = hn::IfThenElse(found, from, to); };
    keep(chosen.face, at.face), keep(chosen.u, at.u), keep(chosen.v, at.v);
    keep(chosen.depth, at.depth), keep(chosen.u_step, at.u_step), keep(chosen.v_step, at.v_step);
    keep(chosen.product, at.product);
    product_x = hn::IfThenElse(is_x, taken, product_x);
    product_y = hn::IfThenElse(is_y, taken, product_y);
    product_z = hn::IfThenElse(hn::Or(is_x, is_y), product_z, taken);
  }
  return chosen;
}

/// Where the taps of a vector of points lie: lanes side by side.
struct TapPlaces {
  alignas(64) int32_t row[kMostTaps][kMostLanes];     ///< the lower texel row, in floats
  alignas(64) int32_t column[kMostTaps][kMostLanes];  ///< the left texel in it
  alignas(64) float above[kMostTaps][kMostLanes];     ///< share of the upper row
  alignas(64) float right[kMostTaps][kMostLanes];
};

HWY_INLINE void place_taps(const NativeCube& cube, const PointsOnFaces& at, V spacing_mm, int taps, TapPlaces& places) {
  const Tag d;
  const IndexTag di;
  // The border of nothing stands for all beyond it.
  const V lowest = hn::Set(d, -1.0f), highest = hn::Set(d, static_cast<float>(cube.size_px()) - 5e-4f);
  for (int k = 0; k < taps; ++k) {
    const V offset = hn::Mul(spacing_mm, hn::Set(d, static_cast<float>(k) - 0.5f * static_cast<float>(taps - 1)));
    const auto place = [&](V centre, V step, V& low) HWY_ATTR {
      const V on = hn::Min(hn::Max(hn::MulAdd(offset, step, centre), lowest), highest);
      low = hn::Floor(on);
      return hn::Sub(on, low);
    };
    V left, low;
    hn::Store(place(at.u, at.u_step, left), d, places.right[k]);
    hn::Store(place(at.v, at.v_step, low), d, places.above[k]);
    const Index one = hn::Set(di, 1);
    const Index rows = hn::Mul(hn::Add(hn::ConvertTo(di, low), one), hn::Set(di, cube.row_texels()));
    const Index face = hn::Mul(hn::ConvertTo(di, at.face), hn::Set(di, cube.face_texels()));
    hn::Store(hn::ShiftLeft<3>(hn::Add(face, rows)), di, places.row[k]);
    hn::Store(hn::ShiftLeft<3>(hn::Add(hn::ConvertTo(di, left), one)), di, places.column[k]);
  }
}

/// A row of taps, filtered: what NativeCube's texels hold, by tap, lane and field.
struct FilteredTaps {
  alignas(64) float light[kMostTaps][4 * kMostLanes];
  alignas(64) float surface[kMostTaps][4 * kMostLanes];
};

HWY_INLINE void filter_row(const NativeCube& cube, const TapPlaces& places, int row, int taps, FilteredTaps& filtered) {
  const hn::CappedTag<float, kTexel> d8;
  const size_t width = hn::Lanes(d8);
  const size_t up = static_cast<size_t>(kTexel) * static_cast<size_t>(cube.row_texels());
  for (size_t lane = 0; lane < hn::Lanes(Tag()); ++lane) {
    const float* lower = cube.texels() + places.row[row][lane];
    const auto above = hn::Set(d8, places.above[row][lane]);
    for (int tap = 0; tap < taps; ++tap) {
      const float* left = lower + places.column[tap][lane];
      const auto right = hn::Set(d8, places.right[tap][lane]);
      for (size_t part = 0; part < kTexel; part += width) {
        const auto mix = [&](const float* from) HWY_ATTR {
          const auto a = hn::LoadU(d8, from + part), b = hn::LoadU(d8, from + kTexel + part);
          return hn::MulAdd(right, hn::Sub(b, a), a);
        };
        const auto low = mix(left), high = mix(left + up);
        const auto texel = hn::MulAdd(above, hn::Sub(high, low), low);
        float* const light = filtered.light[tap] + 4 * lane;
        float* const surface = filtered.surface[tap] + 4 * lane;
#if HWY_MAX_BYTES >= 32
        const hn::Half<decltype(d8)> d4;
        hn::Store(hn::LowerHalf(d4, texel), d4, light);
        hn::Store(hn::UpperHalf(d4, texel), d4, surface);
#else
        hn::Store(texel, d8, part < 4 ? light + part : surface + part - 4);
#endif
      }
    }
  }
}

/// Σ E·Rd·dA over N×N bilinear taps that span the half-width k = (N·f)·l around each point on its face.
HWY_INLINE void gather_taps(const ScatteringBody& body, const PointsOnFaces& at, V (&sum)[3]) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const int taps = static_cast<int>(body.settings.kernel_taps);
  const float half_width_mm = body.material.virtual_height_mm.a;
  const V spacing_mm = hn::Mul(at.product, hn::Set(d, 2 * half_width_mm / static_cast<float>(taps)));
  TapPlaces places;
  place_taps(body.cube, at, spacing_mm, taps, places);
  const diffusion::KernelTable& table = body.kernels.far_table();
  const V spacing2 = hn::Mul(spacing_mm, spacing_mm);
  FilteredTaps filtered;
  for (V& channel : sum) channel = zero;
  for (int j = 0; j < taps; ++j) {
    filter_row(body.cube, places, j, taps, filtered);
    const float middle = 0.5f * static_cast<float>(taps - 1);
    for (int i = 0; i < taps; ++i) {
      V light[3], unused, along_u, along_v, depth, coverage;
      hn::LoadInterleaved4(d, filtered.light[i], light[0], light[1], light[2], unused);
      hn::LoadInterleaved4(d, filtered.surface[i], along_u, along_v, depth, coverage);
      const Mask there = hn::Ge(coverage, hn::Set(d, 1e-3f));
      const V inverse = hn::Div(one, hn::IfThenElse(there, coverage, one));
      along_u = hn::Mul(along_u, inverse), along_v = hn::Mul(along_v, inverse);
      const V rest2 = hn::NegMulAdd(along_u, along_u, hn::NegMulAdd(along_v, along_v, one));
      const V facing = hn::Sqrt(hn::Max(rest2, hn::Set(d, 0.05f * 0.05f)));
      const V apart = hn::NegMulAdd(depth, inverse, at.depth);
      const float u = static_cast<float>(i) - middle, v = static_cast<float>(j) - middle;
      const V distance2 = hn::MulAdd(spacing2, hn::Set(d, u * u + v * v), hn::Mul(apart, apart));
      const auto found = diffusion::HWY_NAMESPACE::locate(body.kernels.domain(), distance2);
      const V weight = hn::IfThenElseZero(there, hn::Div(found.inverse3, facing));
      for (int c = 0; c < 3; ++c) {
        const V kernel = diffusion::HWY_NAMESPACE::cubic(table.coefficient[0][c], found);
        sum[c] = hn::MulAdd(hn::Mul(light[c], weight), kernel, sum[c]);
      }
    }
  }
  const V area = hn::IfThenElseZero(hn::Gt(at.product, zero), spacing2);
  for (V& channel : sum) channel = hn::Mul(channel, area);
}

struct Place {
  V x, y, z, n_x, n_y, n_z;
};

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) { return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz))); }

/// The way of parallel light through the body's box.
HWY_INLINE V way_through_box(const BoxUniforms& box, const LightStorage& light, const Place& at) {
  const Tag d;
  V least = hn::Set(d, 3e38f);
  const V position[] = {at.x, at.y, at.z};
  for (int a = 0; a < 3; ++a) {
    const float towards = light.position_mm[a];
    const float sign = towards > 0 ? 1.0f : towards < 0 ? -1.0f : 0.0f;
    const float wall_mm = box.centre_mm[a] + 0.5f * sign * box.extent_mm[a];
    const V way = hn::Mul(hn::Sub(hn::Set(d, wall_mm), position[a]), hn::Set(d, 1 / (towards == 0 ? 1e-9f : towards)));
    least = hn::Min(least, hn::Abs(way));
  }
  return least;
}

/// As global_radiosity() of paper_shade.frag: Eqs. 9 and 10.
HWY_INLINE void add_global(const ScatteringBody& body, const LightStorage& light, const Place& at, V (&sum)[3]) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const MaterialUniforms& material = body.material;
  V x = hn::Set(d, light.position_mm.x), y = hn::Set(d, light.position_mm.y), z = hn::Set(d, light.position_mm.z);
  V share = hn::Set(d, body.settings.global_gain * (body.lit ? light.shape.z : 1.0f));
  V travelled_mm;
  if (light.power.a != 0) {
    travelled_mm = way_through_box(body.cube.box(), light, at);
  } else {
    x = hn::Sub(x, at.x), y = hn::Sub(y, at.y), z = hn::Sub(z, at.z);
    const V squared = hn::Max(dot(x, y, z, x, y, z), hn::Set(d, 1e-12f));
    travelled_mm = hn::Sqrt(squared);
    const V inverse = hn::Div(one, travelled_mm);
    x = hn::Mul(x, inverse), y = hn::Mul(y, inverse), z = hn::Mul(z, inverse);
    share = hn::Mul(share, hn::Mul(inverse, inverse));
    if (light.axis.a >= -1) {
      const V along = dot(x, y, z, hn::Set(d, light.axis.x), hn::Set(d, light.axis.y), hn::Set(d, light.axis.z));
      const V inwards = hn::Mul(hn::Sub(hn::Set(d, -light.axis.a), along), hn::Set(d, light.shape.x));
      const V cone = hn::Min(hn::Max(inwards, zero), one);
      share = hn::Mul(share, hn::Mul(hn::Mul(cone, cone), hn::NegMulAdd(hn::Set(d, 2.0f), cone, hn::Set(d, 3.0f))));
    }
  }
  const V cosine = hn::Min(hn::Abs(dot(x, y, z, at.n_x, at.n_y, at.n_z)), one);
  share = hn::Mul(share, hn::Mul(cosine, fresnel_transmittance(material.mean_free_path_mm.a, cosine)));
  for (int c = 0; c < 3; ++c) {
    const V l = hn::Set(d, material.mean_free_path_mm[c]);
    const V s = hn::Max(travelled_mm, l);
    const V optical = hn::Mul(hn::Set(d, material.effective_transport_mm[c]), s);
    const V ratio = hn::Div(l, s);
    const V decayed = hn::Mul(hn::Add(one, optical), hn::Exp(d, hn::Neg(optical)));
    const V gain = hn::Set(d, 0.25f * material.reduced_albedo[c] * light.power[c]);
    sum[c] = hn::MulAdd(hn::Mul(hn::Mul(share, gain), hn::Mul(ratio, hn::Mul(ratio, ratio))), decayed, sum[c]);
  }
}

void scatter_points(const ScatteringBody& body, const PointBatch& points, EnteringLight& radiosity) {
  const Tag d;
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    V sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (body.settings.terms != Terms::kGlobal) {
      const PointsOnFaces at = choose_faces(body.cube, points, i);
      if (!hn::AllTrue(d, hn::Eq(at.product, hn::Zero(d)))) gather_taps(body, at, sum);
    }
    if (body.settings.terms != Terms::kLocal) {
      const SurfacePoints& surface = points.surface;
      const Place at{hn::Load(d, surface.x + i),        hn::Load(d, surface.y + i),
                     hn::Load(d, surface.z + i),        hn::Load(d, surface.normal_x + i),
                     hn::Load(d, surface.normal_y + i), hn::Load(d, surface.normal_z + i)};
      for (const LightStorage& light : body.lights) add_global(body, light, at, sum);
    }
    for (int c = 0; c < 3; ++c) hn::Store(sum[c], d, radiosity.channel[c] + i);
  }
}

void leave_points(float refractive_index, const glm::vec3& eye_mm, const PointBatch& points,
                  float* radiance_of_radiosity) {
  const Tag d;
  const V one = hn::Set(d, 1.0f);
  const SurfacePoints& surface = points.surface;
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const V x = hn::Sub(hn::Set(d, eye_mm.x), hn::Load(d, surface.x + i));
    const V y = hn::Sub(hn::Set(d, eye_mm.y), hn::Load(d, surface.y + i));
    const V z = hn::Sub(hn::Set(d, eye_mm.z), hn::Load(d, surface.z + i));
    const V along = dot(x, y, z, hn::Load(d, surface.normal_x + i), hn::Load(d, surface.normal_y + i),
                        hn::Load(d, surface.normal_z + i));
    const V length2 = hn::Max(dot(x, y, z, x, y, z), hn::Set(d, 1e-30f));
    const V cosine = hn::Min(hn::Div(hn::Abs(along), hn::Sqrt(length2)), one);
    const V transmittance = fresnel_transmittance(refractive_index, cosine);
    hn::Store(hn::Mul(transmittance, hn::Set(d, std::numbers::inv_pi_v<float>)), d, radiance_of_radiosity + i);
  }
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(scatter_points);
HWY_EXPORT(leave_points);

void scatter(const ScatteringBody& body, const PointBatch& points, EnteringLight& radiosity) {
  HWY_DYNAMIC_DISPATCH(scatter_points)(body, points, radiosity);
}

void leave(float refractive_index, const glm::vec3& eye_mm, const PointBatch& points, float* radiance_of_radiosity) {
  HWY_DYNAMIC_DISPATCH(leave_points)(refractive_index, eye_mm, points, radiance_of_radiosity);
}

}  // namespace diaphane::render
#endif

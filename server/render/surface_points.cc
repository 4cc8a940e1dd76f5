#include "render/surface_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface_points.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using IndexTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using Index = hn::Vec<IndexTag>;

struct V3 {
  V x, y, z;
};

HWY_INLINE V dot(const V3& a, const V3& b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }
HWY_INLINE V3 minus(const V3& a, const V3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE V3 scaled(const V3& a, V by) { return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)}; }

/// The corners of a vector of triangles, as places in arrays of three floats.
struct Corners {
  Index of[3];
};

HWY_INLINE Corners corners_of(const RasterMesh& mesh, const uint32_t* triangles) {
  const IndexTag di;
  const Index three = hn::Set(di, 3);
  const Index first = hn::Mul(hn::Load(di, reinterpret_cast<const int32_t*>(triangles)), three);
  const auto* vertices = reinterpret_cast<const int32_t*>(mesh.triangles.data());
  Corners corners;
  for (int k = 0; k < 3; ++k) {
    corners.of[k] = hn::Mul(hn::GatherIndex(di, vertices, hn::Add(first, hn::Set(di, k))), three);
  }
  return corners;
}

HWY_INLINE V3 at(std::span<const glm::vec3> values, Index place) {
  const Tag d;
  const IndexTag di;
  const float* from = &values.data()->x;
  return {hn::GatherIndex(d, from, place), hn::GatherIndex(d, from, hn::Add(place, hn::Set(di, 1))),
          hn::GatherIndex(d, from, hn::Add(place, hn::Set(di, 2)))};
}

/// How much each corner counts. A centre on the very edge of the raster's triangle may lie beside the exact one.
struct Weights {
  V of[3];
};

HWY_INLINE Weights normalised(V a, V b, V c) {
  const Tag d;
  const V zero = hn::Zero(d);
  const V sign = hn::CopySignToAbs(hn::Set(d, 1.0f), hn::Add(a, hn::Add(b, c)));
  a = hn::Max(hn::Mul(a, sign), zero), b = hn::Max(hn::Mul(b, sign), zero), c = hn::Max(hn::Mul(c, sign), zero);
  const V sum = hn::Add(a, hn::Add(b, c));
  const V inverse = hn::Div(hn::Set(d, 1.0f), sum);
  const auto whole = hn::Gt(sum, zero);
  return {hn::IfThenElse(whole, hn::Mul(a, inverse), hn::Set(d, 1.0f)), hn::IfThenElseZero(whole, hn::Mul(b, inverse)),
          hn::IfThenElseZero(whole, hn::Mul(c, inverse))};
}

HWY_INLINE V3 weighed(const Weights& w, const V3& a, const V3& b, const V3& c) {
  const auto mix = [&](V p, V q, V r)
                       HWY_ATTR { return hn::MulAdd(w.of[0], p, hn::MulAdd(w.of[1], q, hn::Mul(w.of[2], r))); };
  return {mix(a.x, b.x, c.x), mix(a.y, b.y, c.y), mix(a.z, b.z, c.z)};
}

HWY_INLINE V3 unit(const V3& a) {
  const Tag d;
  const V length2 = hn::Max(dot(a, a), hn::Set(d, 1e-30f));
  return scaled(a, hn::Div(hn::Set(d, 1.0f), hn::Sqrt(length2)));
}

HWY_INLINE V3 interpolate(std::span<const glm::vec3> values, const Corners& corners, const Weights& weights) {
  return weighed(weights, at(values, corners.of[0]), at(values, corners.of[1]), at(values, corners.of[2]));
}

HWY_INLINE void store(const V3& position, const V3& normal, size_t i, SurfacePoints& to) {
  const Tag d;
  hn::Store(position.x, d, to.x + i), hn::Store(position.y, d, to.y + i), hn::Store(position.z, d, to.z + i);
  hn::Store(normal.x, d, to.normal_x + i), hn::Store(normal.y, d, to.normal_y + i);
  hn::Store(normal.z, d, to.normal_z + i);
}

HWY_INLINE void store_values(const RasterMesh& mesh, const Corners& corners, const Weights& weights, size_t i,
                             PointBatch& points) {
  if (mesh.values.empty()) return;
  const Tag d;
  const V3 value = interpolate(mesh.values, corners, weights);
  hn::Store(value.x, d, points.value[0] + i), hn::Store(value.y, d, points.value[1] + i);
  hn::Store(value.z, d, points.value[2] + i);
}

/// Perspective-correct: the weights are areas in clip space, with the pixel at its origin (Olano and Greer 1997).
void view_points(const RasterMesh& mesh, const glm::mat4& clip, const glm::vec3& eye_mm, PointBatch& points) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto row = [&](int r, const V3& p) HWY_ATTR {
    return hn::MulAdd(
        hn::Set(d, clip[0][r]), p.x,
        hn::MulAdd(hn::Set(d, clip[1][r]), p.y, hn::MulAdd(hn::Set(d, clip[2][r]), p.z, hn::Set(d, clip[3][r]))));
  };
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const Corners corners = corners_of(mesh, points.triangle + i);
    const V pixel_x = hn::Load(d, points.x + i), pixel_y = hn::Load(d, points.y + i);
    V3 p[3];
    V x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = at(mesh.positions_mm, corners.of[k]);
      const V w = row(3, p[k]);
      x[k] = hn::NegMulAdd(pixel_x, w, row(0, p[k]));
      y[k] = hn::NegMulAdd(pixel_y, w, row(1, p[k]));
    }
    const V a = hn::MulSub(x[1], y[2], hn::Mul(x[2], y[1]));
    const V b = hn::MulSub(x[2], y[0], hn::Mul(x[0], y[2]));
    const V c = hn::MulSub(x[0], y[1], hn::Mul(x[1], y[0]));
    const Weights weights = normalised(a, b, c);
    const V3 position = weighed(weights, p[0], p[1], p[2]);
    V3 normal = unit(interpolate(mesh.normals, corners, weights));
    // As gbuffer.frag: the inside of an open surface is shaded as a surface of its own.
    const V turn = hn::Add(a, hn::Add(b, c));
    const auto back = mesh.flipped ? hn::Gt(turn, zero) : hn::Lt(turn, zero);
    const V3 to_eye = minus({hn::Set(d, eye_mm.x), hn::Set(d, eye_mm.y), hn::Set(d, eye_mm.z)}, position);
    const auto inside = hn::And(back, hn::Lt(dot(normal, to_eye), zero));
    normal = scaled(normal, hn::IfThenElse(inside, hn::Neg(one), one));
    const V3 facet = cross(minus(p[1], p[0]), minus(p[2], p[0]));
    const V3 across = cross(normal, facet);
    const V facet2 = hn::Max(dot(facet, facet), hn::Set(d, 1e-38f));
    hn::Store(hn::Min(hn::Sqrt(hn::Div(dot(across, across), facet2)), one), d, points.facet_sine + i);
    hn::Store(hn::IfThenElse(inside, zero, one), d, points.outside + i);
    store(position, normal, i, points.surface);
    store_values(mesh, corners, weights, i, points);
  }
}

void face_points(const RasterMesh& mesh, int axis, PointBatch& points) {
  const Tag d;
  const auto u_of = [&](const V3& p) HWY_ATTR { return axis == 2 ? p.x : axis == 0 ? p.y : p.z; };
  const auto v_of = [&](const V3& p) HWY_ATTR { return axis == 0 ? p.z : axis == 1 ? p.x : p.y; };
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const Corners corners = corners_of(mesh, points.triangle + i);
    V3 p[3];
    V x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = at(mesh.positions_mm, corners.of[k]);
      x[k] = hn::Sub(u_of(p[k]), hn::Load(d, points.x + i));
      y[k] = hn::Sub(v_of(p[k]), hn::Load(d, points.y + i));
    }
    const Weights weights =
        normalised(hn::MulSub(x[1], y[2], hn::Mul(x[2], y[1])), hn::MulSub(x[2], y[0], hn::Mul(x[0], y[2])),
                   hn::MulSub(x[0], y[1], hn::Mul(x[1], y[0])));
    store(weighed(weights, p[0], p[1], p[2]), unit(interpolate(mesh.normals, corners, weights)), i, points.surface);
    store_values(mesh, corners, weights, i, points);
  }
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(view_points);
HWY_EXPORT(face_points);

void PointBatch::pad() {
  const size_t last = count - 1;
  for (size_t i = count; i % SurfacePoints::kPadding != 0; ++i) {
    triangle[i] = triangle[last];
    x[i] = x[last];
    y[i] = y[last];
  }
}

void find_view_points(const RasterMesh& mesh, const glm::mat4& clip_from_world, const glm::vec3& eye_mm,
                      PointBatch& points) {
  points.pad();
  HWY_DYNAMIC_DISPATCH(view_points)(mesh, clip_from_world, eye_mm, points);
}

void find_face_points(const RasterMesh& mesh, int axis, PointBatch& points) {
  points.pad();
  HWY_DYNAMIC_DISPATCH(face_points)(mesh, axis, points);
}

}  // namespace diaphane::render
#endif

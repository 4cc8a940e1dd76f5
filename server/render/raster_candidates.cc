#include "render/raster_candidates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster_candidates.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using IndexTag = hn::ScalableTag<int32_t>;
using Tag = hn::RebindToFloat<IndexTag>;
using Index = hn::Vec<IndexTag>;
using V = hn::Vec<Tag>;

/// Whether a pixel's centre lies between two places, and within the raster.
HWY_INLINE hn::Mask<IndexTag> holds_centre(Index a, Index b, Index c, int32_t size_px) {
  const IndexTag di;
  const Index low = hn::Min(a, hn::Min(b, c)), high = hn::Max(a, hn::Max(b, c));
  const Index begin = hn::Max(hn::ShiftRight<8>(hn::Add(low, hn::Set(di, 127))), hn::Zero(di));
  const Index end = hn::Min(hn::ShiftRight<8>(hn::Add(high, hn::Set(di, 128))), hn::Set(di, size_px));
  return hn::Lt(begin, end);
}

/// Places of the corners of the triangles from `i` on, in numbers; past `end` those of the one at `i`.
HWY_INLINE void load_corners(const glm::uvec3* triangles, size_t i, size_t end, Index (&place)[3]) {
  const IndexTag di;
  const size_t lanes = hn::Lanes(di);
  const auto* vertices = reinterpret_cast<const int32_t*>(triangles + i);
  alignas(64) int32_t last[3 * hn::MaxLanes(di)];
  if (end - i < lanes) {
    for (size_t k = 0; k < 3 * lanes; ++k) last[k] = vertices[k < 3 * (end - i) ? k : k % 3];
    vertices = last;
  }
  hn::LoadInterleaved3(di, vertices, place[0], place[1], place[2]);
  const Index three = hn::Set(di, 3);
  for (Index& number : place) number = hn::Mul(number, three);
}

size_t candidates_of(const glm::uvec3* triangles, size_t begin, size_t end, const CornerPlaces& corners, Turn turn,
                     uint32_t* candidates) {
  const IndexTag di;
  const Tag d;
  size_t found = 0;
  for (size_t i = begin; i < end; i += hn::Lanes(di)) {
    const Index own = hn::Iota(di, static_cast<int32_t>(i));
    const auto there = hn::Lt(own, hn::Set(di, static_cast<int32_t>(end)));
    Index place[3], x[3], y[3];
    load_corners(triangles, i, end, place);
    for (int k = 0; k < 3; ++k) {
      x[k] = hn::GatherIndex(di, corners.x, place[k]);
      y[k] = hn::GatherIndex(di, corners.y, place[k]);
    }
    auto keeps = hn::And(there, hn::And(holds_centre(x[0], x[1], x[2], corners.width_px),
                                        holds_centre(y[0], y[1], y[2], corners.height_px)));
    if (turn != Turn::kEither) {
      const auto apart = [&](Index a, Index b) HWY_ATTR { return hn::ConvertTo(d, hn::Sub(a, b)); };
      const V one = hn::Mul(apart(x[1], x[0]), apart(y[2], y[0])),
              other = hn::Mul(apart(y[1], y[0]), apart(x[2], x[0]));
      const V area = turn == Turn::kClockwise ? hn::Sub(other, one) : hn::Sub(one, other);
      // Rounding must lose none.
      const V slack = hn::Mul(hn::Add(hn::Abs(one), hn::Abs(other)), hn::Set(d, 1e-6f));
      keeps = hn::And(keeps, hn::RebindMask(di, hn::Gt(hn::Add(area, slack), hn::Zero(d))));
    }
    found += hn::CompressStore(own, keeps, di, reinterpret_cast<int32_t*>(candidates + found));
  }
  return found;
}

void candidates_by_axis(const glm::uvec3* triangles, size_t begin, size_t end, const int32_t* corners, int32_t size_px,
                        uint32_t* const (&candidates)[3], size_t (&counts)[3]) {
  const IndexTag di;
  size_t found[3] = {};
  for (size_t i = begin; i < end; i += hn::Lanes(di)) {
    const Index own = hn::Iota(di, static_cast<int32_t>(i));
    const auto there = hn::Lt(own, hn::Set(di, static_cast<int32_t>(end)));
    Index place[3];
    load_corners(triangles, i, end, place);
    hn::Mask<IndexTag> holds[3];
    for (int a = 0; a < 3; ++a) {
      holds[a] = holds_centre(hn::GatherIndex(di, corners + a, place[0]), hn::GatherIndex(di, corners + a, place[1]),
                              hn::GatherIndex(di, corners + a, place[2]), size_px);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto keeps = hn::And(there, hn::And(holds[(axis + 1) % 3], holds[(axis + 2) % 3]));
      found[axis] += hn::CompressStore(own, keeps, di, reinterpret_cast<int32_t*>(candidates[axis] + found[axis]));
    }
  }
  for (int axis = 0; axis < 3; ++axis) counts[axis] = found[axis];
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(candidates_of);
HWY_EXPORT(candidates_by_axis);

size_t find_candidates(std::span<const glm::uvec3> triangles, size_t begin, size_t end, const CornerPlaces& corners,
                       Turn turn, uint32_t* candidates) {
  if (begin == end) return 0;
  return HWY_DYNAMIC_DISPATCH(candidates_of)(triangles.data(), begin, end, corners, turn, candidates);
}

void find_candidates_by_axis(std::span<const glm::uvec3> triangles, size_t begin, size_t end, const int32_t* corners,
                             int32_t size_px, uint32_t* const (&candidates)[3], size_t (&counts)[3]) {
  HWY_DYNAMIC_DISPATCH(candidates_by_axis)(triangles.data(), begin, end, corners, size_px, candidates, counts);
}

}  // namespace diaphane::render
#endif

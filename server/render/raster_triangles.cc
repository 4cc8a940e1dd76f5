#include "render/raster_triangles.h"

#include <bit>
#include <cstdlib>

#include "render/raster.h"

#ifndef DIAPHANE_RASTER_TRIANGLES_ONCE
#define DIAPHANE_RASTER_TRIANGLES_ONCE
namespace diaphane::render {
namespace {

/// What all triangles of a call share.
struct Raster {
  const glm::uvec3* triangles;
  uint32_t first_index;
  const CornerPlaces& corners;
  const CornerDepths& depths;
  const RasterSide& front;
  const RasterSide& back;
};

inline void raise_sides(const Raster& raster, uint64_t* front, uint64_t* back, int64_t cell, float depth,
                        uint32_t index) {
  if (front != nullptr) raise(front[cell], visible_key(depth, index));
  if (back != nullptr) raise(back[cell], visible_key(raster.depths.whole - depth, index));
}

}  // namespace
}  // namespace diaphane::render
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster_triangles.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<int32_t, 16>;
using FloatTag = hn::RebindToFloat<Tag>;
using Index = hn::Vec<Tag>;
using V = hn::Vec<FloatTag>;
using Mask = hn::Mask<Tag>;

constexpr size_t kMostLanes = 16;
// Pixels are asked in blocks of four columns and as many rows as fill a vector; one by one without vectors.
constexpr int kColumnBits = hn::MaxLanes(Tag()) < 4 ? 0 : 2;
constexpr int32_t kColumns = 1 << kColumnBits;
constexpr auto kRows = static_cast<int32_t>(hn::MaxLanes(Tag())) >> kColumnBits;

/// Triangles side by side, one a lane, and what cover() makes of each.
struct Setup {
  struct Edge {
    alignas(64) int32_t value[kMostLanes], step_x[kMostLanes], step_y[kMostLanes];
  };
  Edge edge[3];  ///< opposite to a, b and c of a counter-clockwise turn
  alignas(64) float depth[kMostLanes], to_b[kMostLanes], to_c[kMostLanes];  ///< of a; more of it for each unit of edge
  alignas(64) int32_t x_begin[kMostLanes], x_end[kMostLanes], y_begin[kMostLanes], y_end[kMostLanes];
  alignas(64) float first_depth[kMostLanes];  ///< at the first pixel
};

struct Corners {
  Index x[3], y[3];
  V depth[3];
};

HWY_INLINE Corners gather_corners(const Raster& raster, Index triangle) {
  const Tag d;
  const FloatTag df;
  const Index three = hn::Set(d, 3);
  const auto* vertices = reinterpret_cast<const int32_t*>(raster.triangles);
  const Index first = hn::Mul(triangle, three);
  Corners at;
  for (int k = 0; k < 3; ++k) {
    const Index place = hn::Mul(hn::GatherIndex(d, vertices, hn::Add(first, hn::Set(d, k))), three);
    at.x[k] = hn::GatherIndex(d, raster.corners.x, place);
    at.y[k] = hn::GatherIndex(d, raster.corners.y, place);
    at.depth[k] = raster.depths.real != nullptr ? hn::GatherIndex(df, raster.depths.real, place)
                                                : hn::ConvertTo(df, hn::GatherIndex(d, raster.depths.integer, place));
  }
  return at;
}

HWY_INLINE Index least(const Index (&values)[3]) { return hn::Min(values[0], hn::Min(values[1], values[2])); }
HWY_INLINE Index most(const Index (&values)[3]) { return hn::Max(values[0], hn::Max(values[1], values[2])); }

/// Pixels of one axis whose centres lie within bounds.
struct Range {
  Index begin, end;
};
HWY_INLINE Range range_of(Index low, Index high, int32_t size_px) {
  const Tag d;
  const Index begin = hn::ShiftRight<8>(hn::Add(low, hn::Set(d, kSubpixels / 2 - 1)));
  const Index end = hn::ShiftRight<8>(hn::Add(high, hn::Set(d, kSubpixels / 2)));
  return {hn::Max(begin, hn::Zero(d)), hn::Min(end, hn::Set(d, size_px))};
}

/// The edge's value at the first pixel.
HWY_INLINE Index store_edge(Index from_x, Index from_y, Index to_x, Index to_y, Index first_x, Index first_y,
                            Setup::Edge& edge) {
  const Tag d;
  const Index zero = hn::Zero(d);
  const Index dx = hn::Sub(to_x, from_x), dy = hn::Sub(to_y, from_y);
  const Mask keeps = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Lt(dx, zero)));
  const Index product = hn::Sub(hn::Mul(dx, hn::Sub(first_y, from_y)), hn::Mul(dy, hn::Sub(first_x, from_x)));
  const Index value = hn::Sub(product, hn::IfThenElseZero(hn::Not(keeps), hn::Set(d, 1)));
  hn::Store(value, d, edge.value);
  hn::Store(hn::ShiftLeft<8>(hn::Neg(dy)), d, edge.step_x);
  hn::Store(hn::ShiftLeft<8>(dx), d, edge.step_y);
  return value;
}

HWY_INLINE uint32_t bits_of(Mask mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(Tag(), mask, bytes);
  return bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
}

/// What kinds of triangles the lanes are, by bits.
struct Kinds {
  uint32_t large;                         ///< not set up
  uint32_t counter_clockwise, clockwise;  ///< of the others
  uint32_t one_pixel;                     ///< has no other in its bounds
  uint32_t covers_first;                  ///< covers the first in its bounds
};

/// Those past `count` are of no kind.
HWY_INLINE Kinds set_up(const Raster& raster, const Corners& at, size_t count, Setup& setup) {
  const Tag d;
  const FloatTag df;
  const Index zero = hn::Zero(d);
  const Index x_low = least(at.x), x_high = most(at.x), y_low = least(at.y), y_high = most(at.y);
  // Products of a small one's sides, and of ways to the pixels in its bounds, stay below 2^29.
  const Index small = hn::Set(d, 64 * kSubpixels);
  const Mask is_small = hn::And(hn::Lt(hn::Sub(x_high, x_low), small), hn::Lt(hn::Sub(y_high, y_low), small));
  const Index area = hn::Sub(hn::Mul(hn::Sub(at.x[1], at.x[0]), hn::Sub(at.y[2], at.y[0])),
                             hn::Mul(hn::Sub(at.y[1], at.y[0]), hn::Sub(at.x[2], at.x[0])));
  const Mask turned = hn::Lt(area, zero);
  const Index b_x = hn::IfThenElse(turned, at.x[2], at.x[1]), c_x = hn::IfThenElse(turned, at.x[1], at.x[2]);
  const Index b_y = hn::IfThenElse(turned, at.y[2], at.y[1]), c_y = hn::IfThenElse(turned, at.y[1], at.y[2]);
  const auto turned_real = hn::RebindMask(df, turned);
  const V to_b = hn::Sub(hn::IfThenElse(turned_real, at.depth[2], at.depth[1]), at.depth[0]);
  const V to_c = hn::Sub(hn::IfThenElse(turned_real, at.depth[1], at.depth[2]), at.depth[0]);
  const Range x = range_of(x_low, x_high, raster.corners.width_px);
  const Range y = range_of(y_low, y_high, raster.corners.height_px);
  const Index half = hn::Set(d, kSubpixels / 2);
  const Index first_x = hn::Add(hn::ShiftLeft<8>(x.begin), half), first_y = hn::Add(hn::ShiftLeft<8>(y.begin), half);
  const Index to_a = store_edge(b_x, b_y, c_x, c_y, first_x, first_y, setup.edge[0]);
  const Index of_b = store_edge(c_x, c_y, at.x[0], at.y[0], first_x, first_y, setup.edge[1]);
  const Index of_c = store_edge(at.x[0], at.y[0], b_x, b_y, first_x, first_y, setup.edge[2]);
  const V inverse = hn::Div(hn::Set(df, 1.0f), hn::ConvertTo(df, hn::Abs(area)));
  hn::Store(at.depth[0], df, setup.depth);
  const V by_b = hn::Mul(to_b, inverse), by_c = hn::Mul(to_c, inverse);
  hn::Store(by_b, df, setup.to_b);
  hn::Store(by_c, df, setup.to_c);
  hn::Store(hn::MulAdd(hn::ConvertTo(df, of_b), by_b, hn::MulAdd(hn::ConvertTo(df, of_c), by_c, at.depth[0])), df,
            setup.first_depth);
  hn::Store(x.begin, d, setup.x_begin);
  hn::Store(x.end, d, setup.x_end);
  hn::Store(y.begin, d, setup.y_begin);
  hn::Store(y.end, d, setup.y_end);
  const Index one = hn::Set(d, 1);
  const Mask alone = hn::And(hn::Eq(hn::Sub(x.end, x.begin), one), hn::Eq(hn::Sub(y.end, y.begin), one));
  const Mask first = hn::Gt(hn::Or(to_a, hn::Or(of_b, of_c)), hn::Set(d, -1));
  const uint32_t there = (1u << count) - 1;
  const uint32_t of_small = there & bits_of(is_small);
  return {there & ~of_small, of_small & bits_of(hn::Gt(area, zero)), of_small & bits_of(turned), bits_of(alone),
          bits_of(first)};
}

/// The pixels that one lane covers.
HWY_INLINE void draw_lane(const Raster& raster, const Setup& setup, size_t lane, uint32_t index, uint64_t* front,
                          uint64_t* back) {
  const Tag d;
  const FloatTag df;
  const Index order = hn::Iota(d, 0);
  const Index column = hn::And(order, hn::Set(d, kColumns - 1)), row = hn::ShiftRight<kColumnBits>(order);
  Index left[3], right_step[3], up_step[3];
  for (int k = 0; k < 3; ++k) {
    const Setup::Edge& edge = setup.edge[k];
    const Index step_x = hn::Set(d, edge.step_x[lane]), step_y = hn::Set(d, edge.step_y[lane]);
    left[k] = hn::Add(hn::Set(d, edge.value[lane]), hn::Add(hn::Mul(column, step_x), hn::Mul(row, step_y)));
    right_step[k] = hn::ShiftLeft<kColumnBits>(step_x);
    up_step[k] = hn::Mul(step_y, hn::Set(d, kRows));
  }
  const V depth = hn::Set(df, setup.depth[lane]), to_b = hn::Set(df, setup.to_b[lane]),
          to_c = hn::Set(df, setup.to_c[lane]);
  const int32_t x_begin = setup.x_begin[lane], x_end = setup.x_end[lane];
  const int32_t y_begin = setup.y_begin[lane], y_end = setup.y_end[lane];
  for (int32_t y = y_begin; y < y_end; y += kRows) {
    Index value[3] = {left[0], left[1], left[2]};
    const Mask below_end = hn::Lt(row, hn::Set(d, y_end - y));
    for (int32_t x = x_begin; x < x_end; x += kColumns) {
      const Index outside = hn::Or(value[0], hn::Or(value[1], value[2]));
      const Mask there = hn::And(below_end, hn::Lt(column, hn::Set(d, x_end - x)));
      uint32_t covered = bits_of(hn::And(there, hn::Gt(outside, hn::Set(d, -1))));
      if (covered != 0) {
        alignas(64) float depths[kMostLanes];
        hn::Store(hn::MulAdd(hn::ConvertTo(df, value[1]), to_b, hn::MulAdd(hn::ConvertTo(df, value[2]), to_c, depth)),
                  df, depths);
        for (; covered != 0; covered &= covered - 1) {
          const auto bit = static_cast<uint32_t>(std::countr_zero(covered));
          const int64_t cell = int64_t{y + static_cast<int32_t>(bit / kColumns)} * raster.corners.width_px + x +
                               static_cast<int32_t>(bit % kColumns);
          raise_sides(raster, front, back, cell, depths[bit], index);
        }
      }
      for (int k = 0; k < 3; ++k) value[k] = hn::Add(value[k], right_step[k]);
    }
    for (int k = 0; k < 3; ++k) left[k] = hn::Add(left[k], up_step[k]);
  }
}

/// The same by whole numbers of any size.
void draw_large(const Raster& raster, const glm::uvec3& corners, uint32_t index) {
  RasterPoint p[3];
  float depth[3];
  for (int k = 0; k < 3; ++k) {
    const size_t place = size_t{3} * corners[k];
    p[k] = {raster.corners.x[place], raster.corners.y[place]};
    depth[k] =
        raster.depths.real != nullptr ? raster.depths.real[place] : static_cast<float>(raster.depths.integer[place]);
  }
  const int64_t area = doubled_area(p[0], p[1], p[2]);
  if (area == 0) return;
  const int b = area > 0 ? 1 : 2, c = 3 - b;
  const float to_b = depth[b] - depth[0], to_c = depth[c] - depth[0];
  const auto cells_of = [&](const RasterSide& side) {
    return (area > 0 ? side.counter_clockwise : side.clockwise) ? side.cells : nullptr;
  };
  uint64_t *const front = cells_of(raster.front), *const back = cells_of(raster.back);
  const RasterRange range = raster_range(p[0], p[1], p[2], raster.corners.width_px, raster.corners.height_px);
  cover_any(p[0], p[b], p[c], std::abs(area), range, [&](int x, int y, float of_b, float of_c) {
    const float here = depth[0] + of_b * to_b + of_c * to_c;
    const int64_t cell = int64_t{y} * raster.corners.width_px + x;
    raise_sides(raster, front, back, cell, here, index);
  });
}

void draw_candidates(const Raster& raster, const uint32_t* candidates, size_t count) {
  const Tag d;
  const size_t lanes = hn::Lanes(d);
  Setup setup;
  for (size_t i = 0; i < count; i += lanes) {
    alignas(64) int32_t chosen[kMostLanes];
    const size_t here = HWY_MIN(lanes, count - i);
    for (size_t k = 0; k < lanes; ++k) chosen[k] = static_cast<int32_t>(candidates[i + HWY_MIN(k, here - 1)]);
    const Kinds kinds = set_up(raster, gather_corners(raster, hn::Load(d, chosen)), here, setup);
    const auto index_of = [&](size_t lane) { return raster.first_index + static_cast<uint32_t>(chosen[lane]); };
    const auto draw = [&](uint32_t bits, uint64_t* front, uint64_t* back) HWY_ATTR {
      if (front == nullptr && back == nullptr) return;
      for (uint32_t ones = bits & kinds.one_pixel & kinds.covers_first; ones != 0; ones &= ones - 1) {
        const auto lane = static_cast<size_t>(std::countr_zero(ones));
        const int64_t cell = int64_t{setup.y_begin[lane]} * raster.corners.width_px + setup.x_begin[lane];
        raise_sides(raster, front, back, cell, setup.first_depth[lane], index_of(lane));
      }
      for (uint32_t more = bits & ~kinds.one_pixel; more != 0; more &= more - 1) {
        const auto lane = static_cast<size_t>(std::countr_zero(more));
        draw_lane(raster, setup, lane, index_of(lane), front, back);
      }
    };
    draw(kinds.counter_clockwise, raster.front.counter_clockwise ? raster.front.cells : nullptr,
         raster.back.counter_clockwise ? raster.back.cells : nullptr);
    draw(kinds.clockwise, raster.front.clockwise ? raster.front.cells : nullptr,
         raster.back.clockwise ? raster.back.cells : nullptr);
    for (uint32_t bits = kinds.large; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(bits));
      draw_large(raster, raster.triangles[static_cast<size_t>(chosen[lane])], index_of(lane));
    }
  }
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(draw_candidates);

void draw_triangles(std::span<const glm::uvec3> triangles, std::span<const uint32_t> candidates, uint32_t first_index,
                    const CornerPlaces& corners, const CornerDepths& depths, const RasterSide& front,
                    const RasterSide& back) {
  if (candidates.empty()) return;
  HWY_DYNAMIC_DISPATCH(draw_candidates)
  ({triangles.data(), first_index, corners, depths, front, back}, candidates.data(), candidates.size());
}

}  // namespace diaphane::render
#endif

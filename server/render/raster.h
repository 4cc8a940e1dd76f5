// Which pixels a triangle covers, natively: for software renderers, whose small triangles are dear.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>

namespace diaphane::render {

/// A place on a raster in 1/256 px, rows bottom to top; pixel (0, 0) has its centre at (128, 128).
struct RasterPoint {
  int32_t x, y;
};
inline constexpr int32_t kSubpixels = 256;

/// Twice the area in 1/256² px²; above 0 where the corners run counter-clockwise.
inline int64_t doubled_area(const RasterPoint& a, const RasterPoint& b, const RasterPoint& c) {
  return int64_t{b.x - a.x} * (c.y - a.y) - int64_t{b.y - a.y} * (c.x - a.x);
}

/// Pixels from begin to before end.
struct RasterRange {
  int32_t x_begin, x_end, y_begin, y_end;
};

/// The pixels of a raster whose centres lie within the triangle's bounds.
inline RasterRange raster_range(const RasterPoint& a, const RasterPoint& b, const RasterPoint& c, int32_t width_px,
                                int32_t height_px) {
  constexpr int32_t kHalf = kSubpixels / 2;
  const int32_t x_low = std::min({a.x, b.x, c.x}), x_high = std::max({a.x, b.x, c.x});
  const int32_t y_low = std::min({a.y, b.y, c.y}), y_high = std::max({a.y, b.y, c.y});
  return {std::max((x_low + kHalf - 1) >> 8, 0), std::min((x_high + kHalf) >> 8, width_px),
          std::max((y_low + kHalf - 1) >> 8, 0), std::min((y_high + kHalf) >> 8, height_px)};
}

/// Edge functions, one unit below 0 where a pixel's centre on the edge belongs to the neighbour: top and left edges
/// keep theirs, so that triangles side by side neither overlap nor gape.
template <typename Whole>
struct RasterEdge {
  Whole value, step_x, step_y;
  RasterEdge(const RasterPoint& from, const RasterPoint& to, const RasterPoint& at) {
    const Whole dx = to.x - from.x, dy = to.y - from.y;
    const bool keeps = dy < 0 || (dy == 0 && dx < 0);
    value = dx * (at.y - from.y) - dy * (at.x - from.x) - (keeps ? 0 : 1);
    step_x = -dy * kSubpixels;
    step_y = dx * kSubpixels;
  }
};

/// Calls plot(x, y, share of b, share of c) for the covered pixels of a counter-clockwise triangle. `Whole` holds the
/// products of its sides.
template <typename Whole, typename Plot>
inline void cover(const RasterPoint& a, const RasterPoint& b, const RasterPoint& c, int64_t area,
                  const RasterRange& range, const Plot& plot) {
  const RasterPoint first{range.x_begin * kSubpixels + kSubpixels / 2, range.y_begin * kSubpixels + kSubpixels / 2};
  RasterEdge<Whole> of_a(b, c, first), of_b(c, a, first), of_c(a, b, first);
  const float inverse = 1.0f / static_cast<float>(area);
  for (int32_t y = range.y_begin; y < range.y_end; ++y) {
    Whole ea = of_a.value, eb = of_b.value, ec = of_c.value;
    for (int32_t x = range.x_begin; x < range.x_end; ++x) {
      if ((ea | eb | ec) >= 0) plot(x, y, static_cast<float>(eb) * inverse, static_cast<float>(ec) * inverse);
      ea += of_a.step_x, eb += of_b.step_x, ec += of_c.step_x;
    }
    of_a.value += of_a.step_y, of_b.value += of_b.step_y, of_c.value += of_c.step_y;
  }
}

/// The same with the narrowest integers that will do.
template <typename Plot>
inline void cover_any(const RasterPoint& a, const RasterPoint& b, const RasterPoint& c, int64_t area,
                      const RasterRange& range, const Plot& plot) {
  // Corners within 64 px of each other and of every pixel asked: products stay below 2^29.
  constexpr int32_t kSmall = 64 * kSubpixels;
  const bool small = std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x}) < kSmall &&
                     std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y}) < kSmall;
  if (small) return cover<int32_t>(a, b, c, area, range, plot);
  cover<int64_t>(a, b, c, area, range, plot);
}

/// What a pixel shows: the nearest triangle, the first of those as near. 0: nothing.
inline uint64_t visible_key(float nearness, uint32_t triangle) {
  return uint64_t{std::bit_cast<uint32_t>(std::max(nearness, 0.0f))} << 32 | ~triangle;
}
inline uint32_t triangle_of_key(uint64_t key) { return ~static_cast<uint32_t>(key); }

/// Keeps the greater of both; threads may raise one cell at a time, in any order.
inline void raise(uint64_t& cell, uint64_t key) {
  std::atomic_ref<uint64_t> shared(cell);
  uint64_t seen = shared.load(std::memory_order_relaxed);
  while (seen < key && !shared.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
  }
}

}  // namespace diaphane::render

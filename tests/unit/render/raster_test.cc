// The native raster's parts: which pixels, and their bytes.
#include "render/raster.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "diffusion/simd_level.h"
#include "render/develop.h"
#include "render/raster_candidates.h"
#include "render/raster_triangles.h"
#include "render/srgb_table.h"

namespace diaphane::render {
namespace {

constexpr int32_t kSize_px = 100;

/// Adds one to each pixel that the triangle covers.
void count(const RasterPoint& a, RasterPoint b, RasterPoint c, std::vector<int>& covered) {
  const int64_t area = doubled_area(a, b, c);
  if (area == 0) return;
  if (area < 0) std::swap(b, c);
  cover_any(a, b, c, std::abs(area), raster_range(a, b, c, kSize_px, kSize_px), [&](int x, int y, float u, float v) {
    ++covered[static_cast<size_t>(y * kSize_px + x)];
    EXPECT_GE(u, 0);
    EXPECT_GE(v, 0);
    EXPECT_LE(u + v, 1.0001f);
  });
}

/// A fan about a point, over more than the raster: every pixel is in it.
void expect_each_pixel_once(const RasterPoint& middle, int spokes, int32_t radius) {
  std::vector<int> covered(static_cast<size_t>(kSize_px * kSize_px), 0);
  const auto rim = [&](int k) {
    const double angle = 2 * std::numbers::pi * (k % spokes) / spokes;
    return RasterPoint{middle.x + static_cast<int32_t>(radius * std::cos(angle)),
                       middle.y + static_cast<int32_t>(radius * std::sin(angle))};
  };
  for (int k = 0; k < spokes; ++k) count(middle, rim(k), rim(k + 1), covered);
  for (size_t i = 0; i < covered.size(); ++i) ASSERT_EQ(covered[i], 1) << i << " of " << spokes << " spokes";
}

TEST(Raster, TrianglesSideBySideCoverEachPixelOnce) {
  for (const int spokes : {3, 4, 8, 97, 1000}) {
    // On a pixel's centre, on a corner, and anywhere.
    for (const RasterPoint middle :
         {RasterPoint{50 * 256 + 128, 50 * 256 + 128}, {50 * 256, 50 * 256}, {11111, 9999}}) {
      expect_each_pixel_once(middle, spokes, 100'000);
    }
  }
}

TEST(Raster, TakesCornersFarBeyondThePicture) { expect_each_pixel_once({12345, 6789}, 5, 1 << 24); }

TEST(Raster, NearestOfACellWinsAndTheFirstOfThoseAsNear) {
  uint64_t cell = 0;
  raise(cell, visible_key(1.5f, 7));
  raise(cell, visible_key(1.25f, 1));
  raise(cell, visible_key(1.5f, 3));
  raise(cell, visible_key(1.5f, 9));
  EXPECT_EQ(triangle_of_key(cell), 3u);
}

/// Triangles whose corners have three numbers each, as the raster keeps them.
struct Heap {
  std::vector<int32_t> numbers;
  std::vector<glm::uvec3> triangles;

  RasterPoint corner(size_t triangle, size_t k, int u = 0, int v = 1) const {
    const size_t first = 3 * (3 * triangle + k);
    return {numbers[first + static_cast<size_t>(u)], numbers[first + static_cast<size_t>(v)]};
  }
  int32_t depth(size_t triangle, size_t k) const { return numbers[3 * (3 * triangle + k) + 2]; }
};

/// Most smaller than a pixel or two, some of them larger than all of the raster, some of them without an area.
Heap heap_of(uint32_t count) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int32_t> place(-20 * 256, 120 * 256), depth(0, 25'000);
  Heap heap;
  for (uint32_t t = 0; t < count; ++t) {
    const int32_t reach = t % 100 == 0 ? 200 * 256 : t % 10 == 0 ? 5000 : t % 3 == 0 ? 900 : 300;
    std::uniform_int_distribution<int32_t> side(-reach, reach);
    const int32_t x = place(random), y = place(random);
    for (int k = 0; k < 3; ++k) {
      const bool flat = t % 31 == 0;
      const int32_t along = side(random);
      heap.numbers.insert(heap.numbers.end(), {x + along, y + (flat ? along : side(random)), depth(random)});
    }
    heap.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  return heap;
}

TEST(Raster, CandidatesAreAllThatCoverAPixel) {
  const Heap heap = heap_of(5003);
  const std::vector<glm::uvec3>& triangles = heap.triangles;
  const std::vector<int32_t>& stored = heap.numbers;
  for (const Turn turn : {Turn::kEither, Turn::kCounterClockwise, Turn::kClockwise}) {
    std::vector<uint32_t> found(triangles.size() + 16);
    found.resize(find_candidates(triangles, 1, 5001, {stored.data(), stored.data() + 1, kSize_px, kSize_px}, turn,
                                 found.data()));
    size_t next = 0;
    for (uint32_t t = 1; t < 5001; ++t) {
      const RasterPoint a = heap.corner(t, 0), b = heap.corner(t, 1), c = heap.corner(t, 2);
      const int64_t area = doubled_area(a, b, c);
      const bool turns = turn == Turn::kEither || (area > 0) == (turn == Turn::kCounterClockwise);
      const bool listed = next < found.size() && found[next] == t;
      next += listed;
      const RasterRange range = raster_range(a, b, c, kSize_px, kSize_px);
      const bool holds = range.x_begin < range.x_end && range.y_begin < range.y_end;
      if (!holds) {
        EXPECT_FALSE(listed) << t;
      }
      if (holds && turns) {
        EXPECT_TRUE(listed) << t;
      }
    }
    EXPECT_EQ(next, found.size());
    EXPECT_LT(found.size(), triangles.size());
  }
}

TEST(Raster, CandidatesByAxisAreThoseOfEachAxis) {
  const Heap heap = heap_of(2503);
  std::vector<uint32_t> found[3];
  for (auto& one : found) one.resize(heap.triangles.size() + 16);
  size_t counts[3];
  find_candidates_by_axis(heap.triangles, 1, 2501, heap.numbers.data(), kSize_px,
                          {found[0].data(), found[1].data(), found[2].data()}, counts);
  for (int axis = 0; axis < 3; ++axis) {
    const int32_t* const first = heap.numbers.data();
    std::vector<uint32_t> expected(heap.triangles.size() + 16);
    expected.resize(find_candidates(heap.triangles, 1, 2501,
                                    {first + (axis + 1) % 3, first + (axis + 2) % 3, kSize_px, kSize_px}, Turn::kEither,
                                    expected.data()));
    found[axis].resize(counts[axis]);
    EXPECT_EQ(found[axis], expected) << axis;
    EXPECT_GT(expected.size(), 100u);
  }
}

/// The keys that `heap` leaves on two sides, a pixel at a time.
void draw_slowly(const Heap& heap, float whole, const RasterSide& front, const RasterSide& back) {
  for (size_t t = 0; t < heap.triangles.size(); ++t) {
    const RasterPoint p[] = {heap.corner(t, 0), heap.corner(t, 1), heap.corner(t, 2)};
    const int64_t area = doubled_area(p[0], p[1], p[2]);
    if (area == 0) continue;
    const size_t b = area > 0 ? 1 : 2, c = 3 - b;
    const auto depth = [&](size_t k) { return static_cast<float>(heap.depth(t, k)); };
    cover<int64_t>(p[0], p[b], p[c], std::abs(area), raster_range(p[0], p[1], p[2], kSize_px, kSize_px),
                   [&](int x, int y, float of_b, float of_c) {
                     const float here = depth(0) + of_b * (depth(b) - depth(0)) + of_c * (depth(c) - depth(0));
                     const auto cell = static_cast<size_t>(y * kSize_px + x);
                     const auto index = static_cast<uint32_t>(t) + 5;
                     const auto raise_one = [&](const RasterSide& side, float nearness) {
                       if (area > 0 ? side.counter_clockwise : side.clockwise) {
                         raise(side.cells[cell], visible_key(nearness, index));
                       }
                     };
                     raise_one(front, here);
                     raise_one(back, whole - here);
                   });
  }
}

/// Draws `heap` both ways, and expects the same triangles in nearly all cells: depths may be rounded otherwise.
void expect_same(const Heap& heap, const CornerDepths& depths, bool front_turns_both_ways) {
  constexpr size_t kCells = size_t{kSize_px} * kSize_px;
  std::vector<uint64_t> front(kCells), back(kCells), slow_front(kCells), slow_back(kCells);
  std::vector<uint32_t> candidates(heap.triangles.size() + 16);
  const CornerPlaces corners{heap.numbers.data(), heap.numbers.data() + 1, kSize_px, kSize_px};
  candidates.resize(
      find_candidates(heap.triangles, 0, heap.triangles.size(), corners, Turn::kEither, candidates.data()));
  const auto side = [&](std::vector<uint64_t>& cells, bool is_front) {
    return RasterSide{cells.data(), front_turns_both_ways || is_front, front_turns_both_ways || !is_front};
  };
  draw_triangles(heap.triangles, candidates, 5, corners, depths, side(front, true), side(back, false));
  draw_slowly(heap, depths.whole, side(slow_front, true), side(slow_back, false));
  size_t filled = 0;
  for (const auto& [fast, slow] : {std::pair(&front, &slow_front), std::pair(&back, &slow_back)}) {
    size_t differing = 0;
    for (size_t i = 0; i < kCells; ++i) {
      ASSERT_EQ((*fast)[i] == 0, (*slow)[i] == 0) << i;
      filled += (*fast)[i] != 0;
      differing += triangle_of_key((*fast)[i]) != triangle_of_key((*slow)[i]);
      const auto nearness = [&](uint64_t key) { return std::bit_cast<float>(static_cast<uint32_t>(key >> 32)); };
      EXPECT_NEAR(nearness((*fast)[i]), nearness((*slow)[i]), 0.05f) << i;
    }
    EXPECT_LE(differing, kCells / 1000);
  }
  EXPECT_GT(filled, kCells);
}

TEST(Raster, TrianglesDrawnTogetherAreThoseDrawnOneByOne) {
  const Heap heap = heap_of(4001);
  const float whole = 26'000;
  std::vector<float> real(heap.numbers.size());
  for (size_t i = 0; i < real.size(); ++i) real[i] = static_cast<float>(heap.numbers[i]);
  for (const std::string& level : diffusion::simd_levels()) {
    SCOPED_TRACE(level);
    ASSERT_TRUE(diffusion::choose_simd_level(level));
    expect_same(heap, {.integer = heap.numbers.data() + 2, .whole = whole}, false);
    expect_same(heap, {.integer = heap.numbers.data() + 2, .whole = whole}, true);
    expect_same(heap, {.real = real.data() + 2, .whole = whole}, false);
  }
  diffusion::choose_simd_level("");
}

TEST(Raster, AsManyTrianglesAsLeaveAVectorPartlyEmpty) {
  for (const uint32_t count : {1u, 3u, 15u, 17u, 33u}) {
    Heap heap = heap_of(count);
    for (int32_t& number : heap.numbers) number = std::abs(number) % (90 * 256);
    constexpr size_t kCells = size_t{kSize_px} * kSize_px;
    std::vector<uint64_t> cells(kCells), slow(kCells);
    std::vector<uint32_t> all(count);
    for (uint32_t t = 0; t < count; ++t) all[t] = t;
    draw_triangles(heap.triangles, all, 5, {heap.numbers.data(), heap.numbers.data() + 1, kSize_px, kSize_px},
                   {.integer = heap.numbers.data() + 2}, {cells.data(), true, true}, {});
    draw_slowly(heap, 0, {slow.data(), true, true}, {});
    for (size_t i = 0; i < kCells; ++i) ASSERT_EQ(triangle_of_key(cells[i]), triangle_of_key(slow[i])) << count;
  }
}

TEST(SrgbTable, GivesTheBytesOfTheCurve) {
  const SrgbTable table;
  EXPECT_EQ(table.byte_of(-1), 0);
  EXPECT_EQ(table.byte_of(NAN), 0);
  EXPECT_EQ(table.byte_of(0), 0);
  EXPECT_EQ(table.byte_of(1), 255);
  EXPECT_EQ(table.byte_of(INFINITY), 255);
  for (int i = 1; i < 100'000; ++i) {
    const float linear = static_cast<float>(i) / 100'000;
    const float exact = 255 * encode_srgb(linear);
    EXPECT_NEAR(table.byte_of(linear), exact, 0.51) << linear;
  }
}

}  // namespace
}  // namespace diaphane::render

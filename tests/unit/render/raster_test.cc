// The native raster's parts: which pixels, and their bytes.
#include "render/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "render/develop.h"
#include "render/raster_candidates.h"
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

TEST(Raster, CandidatesAreAllThatCoverAPixel) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int32_t> place(-20 * 256, 120 * 256), side(-400, 400);
  std::vector<RasterPoint> corners;
  std::vector<glm::uvec3> triangles;
  // Places of three numbers a corner, as the raster keeps them.
  std::vector<int32_t> stored;
  for (uint32_t t = 0; t < 5003; ++t) {
    const RasterPoint first{place(random), place(random)};
    for (int k = 0; k < 3; ++k) {
      corners.push_back({first.x + side(random), first.y + side(random)});
      stored.insert(stored.end(), {corners.back().x, corners.back().y, -1});
    }
    triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  for (const Turn turn : {Turn::kEither, Turn::kCounterClockwise, Turn::kClockwise}) {
    std::vector<uint32_t> found(triangles.size() + 16);
    found.resize(find_candidates(triangles, 1, 5001, {stored.data(), stored.data() + 1, kSize_px, kSize_px}, turn,
                                 found.data()));
    size_t next = 0;
    for (uint32_t t = 1; t < 5001; ++t) {
      const RasterPoint &a = corners[3 * t], &b = corners[3 * t + 1], &c = corners[3 * t + 2];
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

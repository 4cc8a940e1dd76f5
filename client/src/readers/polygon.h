// Polygons into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "diaphane/values.h"

namespace diaphane::readers {

/// Splits polygons of one file. Not thread-safe.
///
/// Convex polygons, and those whose plane cannot be told, become a fan around their first corner. Concave ones are
/// clipped ear by ear (Meisters 1975) in the plane of Newell's normal; what cannot be clipped (self-intersecting) ends
/// as a fan. Clipping is cubic at worst, so that it is left to polygons of at most kMostClippedCorners, and to
/// kClippingBudget tests in all: beyond these a fan is made too, and a hostile file costs no more than a second or two.
class PolygonSplitter {
 public:
  static constexpr size_t kMostClippedCorners = 256;
  static constexpr uint64_t kClippingBudget = 200'000'000;

  using Triangle = std::array<uint32_t, 3>;

  /// The n-2 triangles of a polygon of n ≥ 3 corners, as corner numbers 0..n-1, wound as the polygon is. The result is
  /// valid until the next call.
  std::span<const Triangle> split(std::span<const Vec3> corners);

  /// Concave polygons that had to become a fan.
  uint64_t fanned() const { return fanned_; }

 private:
  struct Point {
    double x = 0;
    double y = 0;
  };

  bool project(std::span<const Vec3> corners);
  bool is_convex() const;
  bool clip_ears();
  bool is_ear(uint32_t before, uint32_t corner, uint32_t after);
  void fan(std::span<const uint32_t> corners);

  std::vector<Triangle> triangles_;
  std::vector<Point> points_;
  std::vector<uint32_t> left_;
  uint64_t tests_left_ = kClippingBudget;
  uint64_t fanned_ = 0;
};

}  // namespace diaphane::readers

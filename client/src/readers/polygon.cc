#include "readers/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace diaphane::readers {
namespace {

// Twice the signed area of a, b, c.
template <typename Point>
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

std::span<const PolygonSplitter::Triangle> PolygonSplitter::split(std::span<const Vec3> corners) {
  triangles_.clear();
  left_.resize(corners.size());
  std::iota(left_.begin(), left_.end(), 0u);
  if (corners.size() == 3 || !project(corners) || is_convex()) {
    fan(left_);
  } else if (corners.size() > kMostClippedCorners || !clip_ears()) {
    fan(left_);
    ++fanned_;
  }
  return triangles_;
}

// Drops the axis that Newell's normal is longest along; keeps the polygon counter-clockwise.
bool PolygonSplitter::project(std::span<const Vec3> corners) {
  double nx = 0, ny = 0, nz = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[i + 1 == corners.size() ? 0 : i + 1];
    nx += (double{a.y} - b.y) * (double{a.z} + b.z);
    ny += (double{a.z} - b.z) * (double{a.x} + b.x);
    nz += (double{a.x} - b.x) * (double{a.y} + b.y);
  }
  const double longest = std::max({std::abs(nx), std::abs(ny), std::abs(nz)});
  if (!(longest > 0)) return false;
  points_.resize(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3& c = corners[i];
    if (longest == std::abs(nz)) {
      points_[i] = nz > 0 ? Point{c.x, c.y} : Point{c.y, c.x};
    } else if (longest == std::abs(nx)) {
      points_[i] = nx > 0 ? Point{c.y, c.z} : Point{c.z, c.y};
    } else {
      points_[i] = ny > 0 ? Point{c.z, c.x} : Point{c.x, c.z};
    }
  }
  return true;
}

bool PolygonSplitter::is_convex() const {
  const size_t n = points_.size();
  for (size_t i = 0; i < n; ++i) {
    if (turn(points_[i], points_[(i + 1) % n], points_[(i + 2) % n]) < 0) return false;
  }
  return true;
}

// Takes ears off `left_` until three corners are left. False when it stops short; `left_` then holds the rest.
bool PolygonSplitter::clip_ears() {
  size_t i = 0;
  size_t misses = 0;
  while (left_.size() > 3) {
    const size_t n = left_.size();
    const size_t before = (i + n - 1) % n;
    const size_t after = (i + 1) % n;
    if (is_ear(left_[before], left_[i], left_[after])) {
      triangles_.push_back({left_[before], left_[i], left_[after]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
      i = i == left_.size() ? 0 : i;
      misses = 0;
    } else {
      i = after;
      if (++misses == n) return false;
    }
  }
  fan(left_);
  return true;
}

bool PolygonSplitter::is_ear(uint32_t before, uint32_t corner, uint32_t after) {
  const Point& a = points_[before];
  const Point& b = points_[corner];
  const Point& c = points_[after];
  if (tests_left_ < left_.size()) return false;
  tests_left_ -= left_.size();
  if (!(turn(a, b, c) > 0)) return false;
  for (uint32_t other : left_) {
    if (other == before || other == corner || other == after) continue;
    const Point& p = points_[other];
    const bool at_a_corner = (p.x == a.x && p.y == a.y) || (p.x == b.x && p.y == b.y) || (p.x == c.x && p.y == c.y);
    if (!at_a_corner && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

void PolygonSplitter::fan(std::span<const uint32_t> corners) {
  for (size_t i = 2; i < corners.size(); ++i) triangles_.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace diaphane::readers

// The little vector arithmetic that framing needs, in double.
#pragma once

#include <array>
#include <cmath>

#include "diaphane/values.h"

namespace diaphane::internal {

struct Double3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Double3 widen(const Vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3 narrow(const Double3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Double3 operator+(const Double3& a, const Double3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Double3 operator-(const Double3& a, const Double3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Double3 operator*(double s, const Double3& v) { return {s * v.x, s * v.y, s * v.z}; }
inline double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Double3& v) { return std::sqrt(dot(v, v)); }
/// `fallback` where v has no direction.
inline Double3 unit_or(const Double3& v, const Double3& fallback) {
  const double l = length(v);
  return l > 0 && std::isfinite(l) ? (1 / l) * v : fallback;
}

/// `m` column-major and affine.
inline Double3 transform(const std::array<float, 16>& m, const Vec3& p) {
  return {double{m[0]} * p.x + double{m[4]} * p.y + double{m[8]} * p.z + m[12],
          double{m[1]} * p.x + double{m[5]} * p.y + double{m[9]} * p.z + m[13],
          double{m[2]} * p.x + double{m[6]} * p.y + double{m[10]} * p.z + m[14]};
}

}  // namespace diaphane::internal

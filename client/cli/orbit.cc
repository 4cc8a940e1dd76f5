#include "orbit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace diaphane::cli {
namespace {

constexpr double kSteepest_deg = 85;
constexpr double kNearest = 0.25, kFarthest = 4;

using Double3 = std::array<double, 3>;

double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Double3 scaled(const Double3& a, double factor) { return {factor * a[0], factor * a[1], factor * a[2]}; }
Double3 sum(const Double3& a, const Double3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Double3 unit(const Double3& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }

double radians(double deg) { return deg * M_PI / 180; }

/// Where a camera stands, seen from its target.
struct Stand {
  Double3 up;     ///< unit
  Double3 level;  ///< unit, towards the camera, at right angles to `up`
  double elevation_deg;
  double distance;

  explicit Stand(const Camera& camera) : up(unit({camera.up.x, camera.up.y, camera.up.z})) {
    const Double3 arm{double{camera.eye.x} - camera.target.x, double{camera.eye.y} - camera.target.y,
                      double{camera.eye.z} - camera.target.z};
    const double height = dot(arm, up);
    const Double3 along = sum(arm, scaled(up, -height));
    level = unit(along);
    elevation_deg = std::atan2(height, std::sqrt(dot(along, along))) * 180 / M_PI;
    distance = std::sqrt(dot(arm, arm));
  }
};

}  // namespace

Orbit::Orbit(const Camera& first) : first_(first) { reset(); }

void Orbit::turn(double right_deg, double higher_deg) {
  azimuth_deg_ = std::remainder(azimuth_deg_ + right_deg, 360);
  elevation_deg_ = std::clamp(elevation_deg_ + higher_deg, -kSteepest_deg, kSteepest_deg);
}

void Orbit::move_away(double factor) { distance_ = std::clamp(distance_ * factor, kNearest, kFarthest); }

void Orbit::reset() {
  azimuth_deg_ = 0;
  elevation_deg_ = Stand(first_).elevation_deg;
  distance_ = 1;
}

Camera Orbit::camera() const {
  const Stand stand(first_);
  const double azimuth = radians(azimuth_deg_), elevation = radians(elevation_deg_);
  const Double3 level =
      sum(scaled(stand.level, std::cos(azimuth)), scaled(cross(stand.up, stand.level), std::sin(azimuth)));
  const Double3 way = sum(scaled(level, std::cos(elevation)), scaled(stand.up, std::sin(elevation)));
  const Double3 arm = scaled(way, distance_ * stand.distance);
  Camera camera = first_;
  camera.eye = {static_cast<float>(first_.target.x + arm[0]), static_cast<float>(first_.target.y + arm[1]),
                static_cast<float>(first_.target.z + arm[2])};
  return camera;
}

}  // namespace diaphane::cli

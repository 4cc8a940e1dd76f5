#include "diaphane/framing.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "fmt/format.h"
#include "vector_math.h"

namespace diaphane {
namespace {

using internal::Double3;
using internal::unit_or;
using internal::widen;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLightDistance = 2.5;  // diagonals of the bounds

struct Basis {
  Double3 right;
  Double3 up;
  Double3 backward;  // from the target to the eye
};

// Unit vectors; some basis, too, where `up` runs along `backward`.
Basis basis_of(const Double3& backward, const Double3& up) {
  const Double3 any = std::abs(backward.y) < 0.9 ? Double3{0, 1, 0} : Double3{1, 0, 0};
  const Double3 right = unit_or(cross(up, backward), unit_or(cross(any, backward), {1, 0, 0}));
  return {right, cross(backward, right), backward};
}

// The direction from the middle of a body to whoever looks at its front.
Double3 front(const Double3& up) {
  const Double3 axis = std::abs(up.z) < 0.9 ? Double3{0, 0, 1} : Double3{0, -1, 0};
  return unit_or(axis - dot(axis, up) * up, axis);
}

Double3 middle(const Bounds& bounds) { return 0.5 * (widen(bounds.lowest) + widen(bounds.highest)); }

// A point has no size to frame: it is taken for a body of one unit.
double diagonal(const Bounds& bounds) {
  const double size = internal::length(widen(bounds.highest) - widen(bounds.lowest));
  return size > 0 ? size : 1;
}

// Calls `take` with each placed position; false once one is not finite.
template <typename Take>
bool for_each_position(std::span<const MeshData> meshes, const Take& take) {
  for (const MeshData& mesh : meshes) {
    for (const Vec3& position : mesh.positions) {
      const Double3 placed = internal::transform(mesh.scene_from_mesh, position);
      if (!std::isfinite(placed.x + placed.y + placed.z)) return false;
      take(placed);
    }
  }
  return true;
}

absl::Status no_bounds(bool finite) {
  return absl::InvalidArgumentError(finite ? "meshes: must have a vertex, got none"
                                           : "meshes: must have finite positions, got one that is not");
}

}  // namespace

absl::StatusOr<Bounds> bounds_of(std::span<const MeshData> meshes) {
  Double3 lowest{kInfinity, kInfinity, kInfinity};
  Double3 highest{-kInfinity, -kInfinity, -kInfinity};
  const bool finite = for_each_position(meshes, [&](const Double3& p) {
    lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), std::min(lowest.z, p.z)};
    highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), std::max(highest.z, p.z)};
  });
  if (!finite || lowest.x > highest.x) return no_bounds(finite);
  return Bounds{narrow(lowest), narrow(highest)};
}

absl::StatusOr<double> extent_along(std::span<const MeshData> meshes, const Vec3& direction) {
  const Double3 unit = unit_or(widen(direction), {0, 0, 0});
  if (internal::length(unit) == 0) {
    return absl::InvalidArgumentError(
        fmt::format("direction: must have a length, got {},{},{}", direction.x, direction.y, direction.z));
  }
  double lowest = kInfinity;
  double highest = -kInfinity;
  const bool finite = for_each_position(meshes, [&](const Double3& p) {
    const double height = dot(p, unit);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  });
  if (!finite || lowest > highest) return no_bounds(finite);
  return highest - lowest;
}

Camera frame_camera(const Bounds& bounds, const FramingOptions& options) {
  const Double3 up = unit_or(widen(options.up), {0, 1, 0});
  const Basis basis = basis_of(front(up), up);
  const Double3 centre = middle(bounds);
  const Double3 half = 0.5 * (widen(bounds.highest) - widen(bounds.lowest));
  // The server refuses other fields of view; here they only must not spoil the rest of the camera.
  const double fov_y_deg = std::clamp(options.fov_y_deg, 1.f, 170.f);
  const double tan_y = std::tan(fov_y_deg * std::numbers::pi / 360) * options.fill;
  const double tan_x = tan_y * options.aspect;

  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Double3 q{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
    const double sideways = std::max(std::abs(dot(q, basis.right)) / tan_x, std::abs(dot(q, basis.up)) / tan_y);
    distance = std::max(distance, dot(q, basis.backward) + sideways);
  }
  if (distance <= 0) distance = diagonal(bounds) / tan_y;
  return {.eye = narrow(centre + distance * basis.backward),
          .target = narrow(centre),
          .up = narrow(up),
          .fov_y_deg = options.fov_y_deg};
}

PointLight key_light(const Bounds& bounds, const Camera& camera, double millimetres_per_unit) {
  const Double3 backward = unit_or(widen(camera.eye) - widen(camera.target), {0, 0, 1});
  const Basis basis = basis_of(backward, unit_or(widen(camera.up), {0, 1, 0}));
  const Double3 direction = unit_or(-0.6 * basis.right + 0.7 * basis.up + 0.8 * basis.backward, {0, 0, 1});
  const double distance = kLightDistance * diagonal(bounds);
  const double distance_mm = distance * millimetres_per_unit;
  const auto intensity = static_cast<float>(kKeyRadiance * std::numbers::pi * distance_mm * distance_mm);
  return {narrow(middle(bounds) + distance * direction), {intensity, intensity, intensity}};
}

}  // namespace diaphane

// Where a camera and a light stand when nobody said where. Pure functions, thread-safe.
#pragma once

#include <span>

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"
#include "diaphane/values.h"

namespace diaphane {

/// An axis-aligned box in scene units.
struct Bounds {
  Vec3 lowest;
  Vec3 highest;
};

/// The bounds of every mesh, placed by its scene_from_mesh.
///
/// Errors: INVALID_ARGUMENT when no mesh has a vertex, or a placed position is not finite.
absl::StatusOr<Bounds> bounds_of(std::span<const MeshData> meshes);

/// The extent of every mesh, placed by its scene_from_mesh, along `direction` (of any length but 0), in scene units.
///
/// Errors: INVALID_ARGUMENT as for bounds_of, or for a direction without length.
absl::StatusOr<double> extent_along(std::span<const MeshData> meshes, const Vec3& direction);

struct FramingOptions {
  Vec3 up{0, 1, 0};
  float fov_y_deg = 30;
  float aspect = 16.f / 9;  ///< width over height
  float fill = 0.9f;        ///< share of the frame, in (0, 1], that the box may take
};

/// A camera that looks at the middle of `bounds` from the front, as near as keeps all eight corners within `fill` of
/// the frame. The front is +z, or -y where `up` runs along z.
Camera frame_camera(const Bounds& bounds, const FramingOptions& options = {});

/// The light of a scene that no light was given: a white point light on the upper left, in front of the body as
/// `camera` sees it. It stands 2.5 diagonals D of `bounds` from the middle, in the direction -0.6 right + 0.7 up + 0.8
/// towards the eye, with the intensity kKeyRadiance·π·(2.5 D)² (D in mm): a white Lambertian surface that faces it has
/// the radiance kKeyRadiance, so that the body as a whole comes out mid-bright.
PointLight key_light(const Bounds& bounds, const Camera& camera, double millimetres_per_unit);

/// W·mm⁻²·sr⁻¹
inline constexpr float kKeyRadiance = 0.6f;

}  // namespace diaphane

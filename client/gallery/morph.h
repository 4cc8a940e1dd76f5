// The paper's deformation: a mesh becomes its bounding sphere (§4.5). Plain values.
#pragma once

#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"

namespace diaphane::gallery {

struct Sphere {
  Vec3 centre;
  float radius = 0;
};

/// Around the middle of the mesh's bounds, in mesh units.
///
/// Errors: as bounds_of's.
absl::StatusOr<Sphere> bounding_sphere(const MeshData& mesh);

/// Around a point from which all of the surface is seen, if there is one: the mesh then becomes the sphere without
/// folds.
Sphere bounding_sphere_around(const Vec3& centre, const MeshData& mesh);

/// p' = mix(p, c + R (p − c)/|p − c|, t), t in 0..1.
std::vector<Vec3> morphed(std::span<const Vec3> positions, const Sphere& sphere, float t);

/// Where a point of the morphed body was before, t in 0..1 without 1.
Vec3 unmorphed(const Vec3& position, const Sphere& sphere, float t);

/// The meshes of a file as one, in scene units: a morph is about a common centre.
MeshData merged(std::span<const MeshData> meshes);

}  // namespace diaphane::gallery

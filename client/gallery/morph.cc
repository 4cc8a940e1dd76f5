#include "gallery/morph.h"

#include <algorithm>
#include <cmath>

#include "diaphane/framing.h"

namespace diaphane::gallery {
namespace {

float distance(const Vec3& p, const Vec3& c) { return std::hypot(p.x - c.x, p.y - c.y, p.z - c.z); }

Vec3 scaled_from(const Vec3& p, const Vec3& c, float scale) {
  return {c.x + scale * (p.x - c.x), c.y + scale * (p.y - c.y), c.z + scale * (p.z - c.z)};
}

}  // namespace

absl::StatusOr<Sphere> bounding_sphere(const MeshData& mesh) {
  const absl::StatusOr<Bounds> bounds = bounds_of({&mesh, 1});
  if (!bounds.ok()) return bounds.status();
  return bounding_sphere_around({(bounds->lowest.x + bounds->highest.x) / 2, (bounds->lowest.y + bounds->highest.y) / 2,
                                 (bounds->lowest.z + bounds->highest.z) / 2},
                                mesh);
}

Sphere bounding_sphere_around(const Vec3& centre, const MeshData& mesh) {
  Sphere sphere{centre, 0};
  for (const Vec3& p : mesh.positions) sphere.radius = std::max(sphere.radius, distance(p, centre));
  return sphere;
}

std::vector<Vec3> morphed(std::span<const Vec3> positions, const Sphere& sphere, float t) {
  std::vector<Vec3> result;
  result.reserve(positions.size());
  for (const Vec3& p : positions) {
    const float from_centre = distance(p, sphere.centre);
    const float scale = from_centre > 0 ? 1 + t * (sphere.radius / from_centre - 1) : 1;
    result.push_back(scaled_from(p, sphere.centre, scale));
  }
  return result;
}

Vec3 unmorphed(const Vec3& position, const Sphere& sphere, float t) {
  const float now = distance(position, sphere.centre);
  if (now <= 0) return position;
  return scaled_from(position, sphere.centre, (now - t * sphere.radius) / (1 - t) / now);
}

MeshData merged(std::span<const MeshData> meshes) {
  MeshData all;
  for (const MeshData& mesh : meshes) {
    const auto first = static_cast<uint32_t>(all.positions.size());
    const auto& m = mesh.scene_from_mesh;
    for (const Vec3& p : mesh.positions) {
      all.positions.push_back({m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
                               m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                               m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]});
    }
    for (const uint32_t index : mesh.triangles) all.triangles.push_back(first + index);
  }
  return all;
}

}  // namespace diaphane::gallery

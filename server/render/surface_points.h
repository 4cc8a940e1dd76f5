// Points of a mesh that a raster shows: where they are, their normals, and what the vertices know.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/shape.h"
#include "glm/mat4x4.hpp"
#include "render/entering_light.h"

namespace diaphane::render {

/// A mesh as the native raster reads it, by reference. `values` may be empty: colours at vertices.
struct RasterMesh {
  std::span<const glm::uvec3> triangles;
  std::span<const glm::vec3> positions_mm;
  std::span<const glm::vec3> normals;
  std::span<const glm::vec3> values;
  bool facing_only = false;  ///< triangles that look away are hidden by others
  bool flipped = false;      ///< triangles run clockwise seen from outside
};

/// Up to kCapacity pixels or texels that show one mesh.
struct PointBatch {
  static constexpr size_t kCapacity = SurfacePoints::kCapacity;
  size_t count = 0;
  alignas(64) uint32_t cell[kCapacity];          ///< of the raster
  alignas(64) uint32_t triangle[kCapacity];      ///< of the mesh
  alignas(64) float x[kCapacity], y[kCapacity];  ///< of the cell's centre: clip space of a view, mm of a face

  SurfacePoints surface;                    ///< mm, unit normals
  alignas(64) float facet_sine[kCapacity];  ///< of the angle to the triangle's own normal, 0..1
  alignas(64) float outside[kCapacity];     ///< 1, or 0 on the inside of an open surface, whose normal is turned
  alignas(64) float value[3][kCapacity];    ///< of the vertices, where the mesh has some

  /// Points up to the next multiple of the padding become the last one. At least one is there.
  void pad();
};

/// Finds the points of a view's pixels: `clip_from_world` as the raster had it.
void find_view_points(const RasterMesh& mesh, const glm::mat4& clip_from_world, const glm::vec3& eye_mm,
                      PointBatch& points);

/// Those of a box face's texels, seen along `axis`: x and y are millimetres along the axes that follow it. Normals stay
/// as they are; nothing is said of facets and sides.
void find_face_points(const RasterMesh& mesh, int axis, PointBatch& points);

}  // namespace diaphane::render

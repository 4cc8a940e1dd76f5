#include "geometry/shape.h"

#include <cmath>
#include <limits>

#include "glm/geometric.hpp"
#include "glm/mat3x3.hpp"
#include "glm/matrix.hpp"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"
#include "tbb/parallel_reduce.h"

namespace diaphane::geometry {
namespace {

/// Calls work(i) for i below `count`, spread over all cores.
template <class Work>
void for_each(size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 4096), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

constexpr Bounds kNowhere{glm::vec3(std::numeric_limits<float>::max()),
                          glm::vec3(std::numeric_limits<float>::lowest())};

Bounds merge(const Bounds& a, const Bounds& b) {
  return {glm::min(a.lowest, b.lowest), glm::max(a.highest, b.highest)};
}

/// Unit vector, or `fallback` where `v` has no usable length.
glm::vec3 normalised_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : fallback;
}

/// The cofactor matrix: takes normals where `m` takes points, for singular m too, up to length.
glm::mat3 cofactors(const glm::mat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

namespace {

void fill_normals(const MeshTopology& topology, std::span<const glm::vec3> positions,
                  std::vector<glm::vec3>& area_vectors, std::vector<glm::vec3>& normals) {
  area_vectors.resize(topology.triangles.size());
  for_each(area_vectors.size(), [&](size_t t) {
    const glm::uvec3& i = topology.triangles[t];
    area_vectors[t] = glm::cross(positions[i.y] - positions[i.x], positions[i.z] - positions[i.x]);
  });
  normals.resize(topology.vertex_count);
  for_each(normals.size(), [&](size_t v) {
    const uint32_t w = topology.weld_of_vertex[v];
    glm::vec3 sum(0);
    for (uint32_t k = topology.first_triangle[w]; k < topology.first_triangle[w + 1]; ++k) {
      sum += area_vectors[topology.triangle_of_weld[k]];
    }
    normals[v] = normalised_or(sum, {0, 0, 1});
  });
}

}  // namespace

std::vector<glm::vec3> compute_normals(const MeshTopology& topology, std::span<const glm::vec3> positions) {
  std::vector<glm::vec3> area_vectors, normals;
  fill_normals(topology, positions, area_vectors, normals);
  return normals;
}

Bounds place_positions(const MeshShape& shape, const glm::mat4& scene_from_mesh, double millimetres_per_unit,
                       PlacedShape& placed) {
  placed.flipped = glm::determinant(glm::mat3(scene_from_mesh)) < 0;
  placed.normals.clear();
  placed.positions_mm.resize(shape.positions.size());
  const auto scale = static_cast<float>(millimetres_per_unit);
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<size_t>(0, shape.positions.size(), 4096), kNowhere,
      [&](const tbb::blocked_range<size_t>& range, Bounds bounds) {
        for (size_t v = range.begin(); v != range.end(); ++v) {
          const glm::vec3 placed_mm = glm::vec3(scene_from_mesh * glm::vec4(shape.positions[v], 1)) * scale;
          placed.positions_mm[v] = placed_mm;
          bounds = merge(bounds, {placed_mm, placed_mm});
        }
        return bounds;
      },
      merge);
}

void place_normals(const MeshTopology& topology, const MeshShape& shape, const glm::mat4& scene_from_mesh,
                   PlacedShape& placed, std::vector<glm::vec3>& scratch) {
  fill_normals(topology, placed.positions_mm, scratch, placed.normals);
  if (placed.flipped) {
    for (glm::vec3& n : placed.normals) n = -n;
  }
  if (shape.normals.empty()) return;
  const glm::mat3 normal_from_mesh = cofactors(glm::mat3(scene_from_mesh)) * (placed.flipped ? -1.0f : 1.0f);
  for_each(shape.normals.size(), [&](size_t v) {
    placed.normals[v] = normalised_or(normal_from_mesh * shape.normals[v], placed.normals[v]);
  });
}

Bounds bounds_of(std::span<const glm::vec3> positions) {
  Bounds bounds{positions.front(), positions.front()};
  for (const glm::vec3& p : positions) bounds = merge(bounds, {p, p});
  return bounds;
}

}  // namespace diaphane::geometry

#include "diffusion/surfels.h"

#include <algorithm>
#include <cmath>

#include "glm/geometric.hpp"
#include "tbb/parallel_for.h"

namespace diaphane::diffusion {
namespace {

uint32_t splits_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const SurfelOptions& options) {
  if (!(glm::length(glm::cross(b - a, c - a)) > 0)) return 0;
  const float longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  const float wanted = std::ceil(longest / options.spacing_mm);
  const auto largest = static_cast<float>(std::max(options.largest_splits, options.splits));
  return std::max({options.splits, 1u, static_cast<uint32_t>(std::min(wanted, largest))});
}

}  // namespace

Surfels sample_surface(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions_mm,
                       std::span<const glm::vec3> normals, const IrradianceAt& irradiance,
                       const SurfelOptions& options) {
  std::vector<size_t> first(triangles.size() + 1, 0);
  std::vector<uint32_t> splits(triangles.size());
  Surfels surfels;
  for (size_t t = 0; t < triangles.size(); ++t) {
    const glm::vec3& a = positions_mm[triangles[t].x];
    const glm::vec3& b = positions_mm[triangles[t].y];
    const glm::vec3& c = positions_mm[triangles[t].z];
    splits[t] = splits_of(a, b, c, options);
    first[t + 1] = first[t] + static_cast<size_t>(splits[t]) * splits[t];
    surfels.area_mm2 += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  surfels.positions_mm.resize(first.back());
  surfels.flux_w.resize(first.back());
  tbb::parallel_for(size_t{0}, triangles.size(), [&](size_t t) {
    const glm::uvec3& v = triangles[t];
    const uint32_t n = splits[t];
    if (n == 0) return;
    const float area =
        0.5f * glm::length(glm::cross(positions_mm[v.y] - positions_mm[v.x], positions_mm[v.z] - positions_mm[v.x])) /
        static_cast<float>(n * n);
    size_t slot = first[t];
    const auto add = [&](float i, float j) {
      const float y = i / static_cast<float>(n), z = j / static_cast<float>(n), x = 1 - y - z;
      const glm::vec3 position = x * positions_mm[v.x] + y * positions_mm[v.y] + z * positions_mm[v.z];
      const glm::vec3 normal = x * normals[v.x] + y * normals[v.y] + z * normals[v.z];
      const float length = glm::length(normal);
      surfels.positions_mm[slot] = position;
      surfels.flux_w[slot] = length > 0 ? area * irradiance(position, normal / length) : glm::vec3(0);
      ++slot;
    };
    // Part (i, j) of the barycentric grid, and its neighbour that points the other way.
    for (uint32_t i = 0; i < n; ++i) {
      for (uint32_t j = 0; i + j < n; ++j) {
        add(static_cast<float>(i) + 1.0f / 3, static_cast<float>(j) + 1.0f / 3);
        if (i + j + 1 < n) add(static_cast<float>(i) + 2.0f / 3, static_cast<float>(j) + 2.0f / 3);
      }
    }
  });
  return surfels;
}

}  // namespace diaphane::diffusion

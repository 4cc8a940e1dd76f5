#include "geometry/morph.h"

#include <algorithm>

#include "geometry/shape.h"
#include "glm/geometric.hpp"

namespace diaphane::geometry {

std::vector<glm::vec3> morphed(std::span<const glm::vec3> rest, const MorphTargets& targets,
                               std::span<const float> weights) {
  std::vector<glm::vec3> positions(rest.begin(), rest.end());
  for (size_t target = 0; target < targets.count; ++target) {
    if (weights[target] == 0) continue;
    const glm::vec3* displacements = &targets.displacements[target * rest.size()];
    for (size_t i = 0; i < rest.size(); ++i) positions[i] += weights[target] * displacements[i];
  }
  return positions;
}

std::vector<glm::vec3> morphed_to_sphere(std::span<const glm::vec3> rest, float amount) {
  const Bounds bounds = bounds_of(rest);
  const glm::vec3 centre = 0.5f * (bounds.lowest + bounds.highest);
  float radius = 0;
  for (const glm::vec3& p : rest) radius = std::max(radius, glm::distance(p, centre));
  std::vector<glm::vec3> positions;
  positions.reserve(rest.size());
  for (const glm::vec3& p : rest) {
    const float length = glm::distance(p, centre);
    const float scale = length > 0 ? 1 + amount * (radius / length - 1) : 1;
    positions.push_back(centre + scale * (p - centre));
  }
  return positions;
}

}  // namespace diaphane::geometry

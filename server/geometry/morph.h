// Shapes that a mesh takes by a few numbers, from its uploaded positions. Plain functions, thread-safe.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// Where each target moves each vertex. Immutable once shared.
struct MorphTargets {
  size_t count = 0;
  std::vector<glm::vec3> displacements;  ///< [count][vertex_count], mesh units
};

/// rest + Σ weight · displacement; as many weights as targets.
std::vector<glm::vec3> morphed(std::span<const glm::vec3> rest, const MorphTargets& targets,
                               std::span<const float> weights);

/// p' = mix(p, c + R (p − c)/|p − c|, amount): towards the sphere about the middle c of the bounds of `rest` (at least
/// one position) that holds it (the paper's §4.5). What lies in c stays there.
std::vector<glm::vec3> morphed_to_sphere(std::span<const glm::vec3> rest, float amount);

}  // namespace diaphane::geometry

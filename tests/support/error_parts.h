// Where an error of the integral comes from.
#pragma once

#include <span>
#include <vector>

#include "diffusion/dipole_integral.h"
#include "tests/support/cells.h"

namespace diaphane::testing {

/// The mesh as the server splits it for a material.
Mesh as_served(const Mesh& mesh, const optics::Coefficients& material, diffusion::Quality quality);

/// Radiosity at the vertices of `mesh`, which may be a finer one than the cell's, by `integral` (made of its topology).
std::vector<glm::vec3> integral_radiosity(diffusion::DipoleIntegral& integral, const Mesh& mesh, const Cell& cell,
                                          const diffusion::Openings& openings);

/// Differences from the truth at a point of the surface, RGB, W·mm⁻²; their sum is the integral's.
struct ErrorParts {
  glm::vec3 interpolation{0};  ///< exact values at the vertices, interpolated: what linear triangles cost
  glm::vec3 near_field{0};     ///< all groups opened: E of triangles as points, narrow kernels as a local term, tables
  glm::vec3 far_field{0};      ///< groups of vertices taken as one
};

/// Parts at `points_mm` of the cell's surface, with normals to find them by. The mesh is split as the server splits it.
std::vector<ErrorParts> error_parts(const Cell& cell, diffusion::Quality quality, std::span<const glm::vec3> points_mm,
                                    std::span<const glm::vec3> normals);

}  // namespace diaphane::testing

// A surface as small flat samples with light on them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "glm/vec3.hpp"

namespace diaphane::diffusion {

/// Irradiance E (RGB, W·mm⁻²) that enters the body at a point in mm with a unit normal; called from several threads.
using IrradianceAt = std::function<glm::vec3(const glm::vec3& position_mm, const glm::vec3& normal)>;

/// Points that stand for a piece of surface each, as arrays of one length.
struct Surfels {
  std::vector<glm::vec3> positions_mm;
  std::vector<glm::vec3> flux_w;  ///< E times area, RGB
  double area_mm2 = 0;            ///< the sum of all areas
};

/// How finely triangles are sampled: n² equal parts a triangle, n = the larger of `splits` and longest edge / spacing.
struct SurfelOptions {
  uint32_t splits = 2;
  float spacing_mm = std::numeric_limits<float>::infinity();
  uint32_t largest_splits = 64;
};

/// Samples triangles at the centroids of their parts, with interpolated renormalised normals; triangles without area
/// give nothing. Indices must be below the length of `positions_mm` and `normals`. Thread-safe.
Surfels sample_surface(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions_mm,
                       std::span<const glm::vec3> normals, const IrradianceAt& irradiance,
                       const SurfelOptions& options = {});

}  // namespace diaphane::diffusion

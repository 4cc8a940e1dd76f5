// Point lights, and the irradiance that they give a surface: what the diffusion room does not know.
#pragma once

#include <span>
#include <vector>

#include "diffusion/surface_topology.h"
#include "diffusion/surfels.h"
#include "glm/vec3.hpp"
#include "optics/environment.h"

namespace diaphane::testing {

struct PointLight {
  glm::vec3 position_mm;
  glm::vec3 intensity_w_sr;
};

/// E = Σ I·Ft·cos/d², unshadowed.
diffusion::IrradianceAt irradiance_of(std::vector<PointLight> lights, float refractive_index);

/// E of an environment and its lamps, unshadowed.
diffusion::IrradianceAt irradiance_of(optics::EnvironmentLight light, float refractive_index);

struct SurfaceIrradiance {
  std::vector<glm::vec3> at_triangles;
  std::vector<glm::vec3> at_vertices;
};

/// E at the centroids of `topology.triangles` and at the vertices.
SurfaceIrradiance light_surface(const diffusion::SurfaceTopology& topology, std::span<const glm::vec3> positions_mm,
                                std::span<const glm::vec3> normals, const diffusion::IrradianceAt& irradiance);

}  // namespace diaphane::testing

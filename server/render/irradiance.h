// The light that enters a surface: E at triangles and vertices.
#pragma once

#include <span>
#include <vector>

#include "diffusion/surface_topology.h"
#include "geometry/shape.h"
#include "render/ambient.h"
#include "render/ambient_occlusion.h"
#include "render/shadow.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// E (RGB, W·mm⁻²) of all lights and what is around, Fresnel and clamped cosine included (paper Eq. 4).
struct SurfaceIrradiance {
  std::vector<glm::vec3>
      of_triangle;  ///< at centroids, with the renormalised mean of the vertex normals; the topology's order
  std::vector<glm::vec3> of_vertex;
};

/// What light falls on.
struct LitSurface {
  const diffusion::SurfaceTopology& topology;
  const geometry::PlacedShape& shape;
  std::span<const LightStorage> lights;
  const AmbientIrradiance* ambient;  ///< null: none
  float refractive_index;
};

/// Where E of its triangles or vertices goes.
struct Receivers {
  std::span<glm::vec3> irradiance;
  const float* seen;  ///< where not null, a row of that many values for each light
  const float* open;  ///< where not null, three such rows (RGB): the share of what is around
};

/// Computes E natively, spread over all cores; keeps its memory from call to call. One thread calls.
class IrradianceStage {
 public:
  /// `shadows` null: every light is seen everywhere. A vertex sees of a light what its triangles see, on average.
  /// `occlusion` null: so is what is around; else it has weighed the same mesh.
  void run(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
           std::span<const LightStorage> lights, const Ambient& ambient, float refractive_index, ShadowScene* shadows,
           const AmbientOcclusion* occlusion = nullptr);

  const SurfaceIrradiance& result() const { return irradiance_; }

 private:
  void cast_shadows(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
                    std::span<const LightStorage> lights, ShadowScene& shadows);

  SurfaceIrradiance irradiance_;
  // Visibility, a row a light, with room for whole vectors behind the last.
  std::vector<float> of_triangle_;
  std::vector<float> of_vertex_;
};

}  // namespace diaphane::render

// The paper's second pass in plain memory: what paper_shade.frag does on a GPU.
#pragma once

#include <span>

#include "diffusion/kernel_table.h"
#include "render/frame.h"
#include "render/native_cube.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// What scatters the light of one body. By reference, and read only.
struct ScatteringBody {
  const NativeCube& cube;
  const MaterialUniforms& material;
  const diffusion::KernelSet& kernels;  ///< of the paper's dipole, prepared for the body's size
  std::span<const LightStorage> lights;
  bool lit = false;  ///< the lights' shape.z is the share that the body gets
  const PaperSettings& settings;
};

/// B by channel, W·mm⁻², at points with their normals and facets (paper §4.3, §4.4). Thread-safe.
void scatter(const ScatteringBody& body, const PointBatch& points, EnteringLight& radiosity);

/// Ft(η, cosine)/π at each point, towards the eye: radiance over radiosity (paper Eq. 2). Thread-safe.
void leave(float refractive_index, const glm::vec3& eye_mm, const PointBatch& points, float* radiance_of_radiosity);

}  // namespace diaphane::render

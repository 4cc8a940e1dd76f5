// The light that enters a surface, for many points at once.
#pragma once

#include <cstddef>

#include "render/uniforms.h"

namespace diaphane::render {

/// Points of a surface side by side: positions in mm and unit normals.
struct SurfacePoints {
  static constexpr size_t kCapacity = 256;
  static constexpr size_t kPadding = 16;  ///< whole vectors: points up to its next multiple are read
  alignas(64) float x[kCapacity], y[kCapacity], z[kCapacity];
  alignas(64) float normal_x[kCapacity], normal_y[kCapacity], normal_z[kCapacity];

  void set(size_t i, const glm::vec3& position_mm, const glm::vec3& normal) {
    x[i] = position_mm.x, y[i] = position_mm.y, z[i] = position_mm.z;
    normal_x[i] = normal.x, normal_y[i] = normal.y, normal_z[i] = normal.z;
  }
};

/// E of such points, by channel, W·mm⁻².
struct EnteringLight {
  alignas(64) float channel[3][SurfacePoints::kCapacity];
};

/// Adds what `light` sends into the body at the first `count` points: clamped cosine and Fresnel transmittance (paper
/// Eq. 4), times `seen` (0..1, one for each point) unless that is null. As entering_irradiance(), to rounding.
/// Points up to the next multiple of kPadding are computed too and must be finite. Thread-safe.
void add_entering_light(const LightStorage& light, float refractive_index, const SurfacePoints& points, size_t count,
                        const float* seen, EnteringLight& sum);

}  // namespace diaphane::render

// E with shadows, for techniques whose shaders would find it without.
#pragma once

#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "diffusion/surface_topology.h"
#include "render/irradiance.h"
#include "render/memo.h"
#include "render/shadow.h"
#include "render/stage_clock.h"

namespace diaphane::render {

/// Light on one mesh, shadows included, at its vertices. Stages: order, irradiance; each sleeps while what it reads is
/// the same. One thread calls; work is spread over all cores.
class VertexLight {
 public:
  struct Inputs {
    const geometry::PlacedShape& shape;
    uint64_t shape_generation;
    std::span<const LightStorage> lights;
    float refractive_index;  ///< 1: E without Fresnel
    const ShadowScene& shadows;
    uint64_t shadows_generation;
  };

  void update(const std::shared_ptr<const geometry::MeshTopology>& topology, const Inputs& inputs, StageClock& clock);

  /// E, RGB, W·mm⁻², a value a vertex. Valid until the next update.
  std::span<const glm::vec3> irradiance() const { return irradiance_; }
  /// The lights, with the share of each one's power that shadows leave the mesh in shape.z (see lights.glsl).
  std::span<const LightStorage> lights() const { return lights_; }
  /// Above 0, and grows whenever irradiance or lights change.
  uint64_t generation() const { return generation_; }
  size_t bytes() const;

 private:
  /// ∫ E dA of the stage's last run, all channels.
  double power(const geometry::PlacedShape& shape) const;

  std::shared_ptr<const diffusion::SurfaceTopology> topology_;
  IrradianceStage stage_;
  std::vector<glm::vec3> irradiance_;
  std::vector<LightStorage> lights_;
  Memo<std::tuple<uint64_t, std::vector<LightStorage>, float, uint64_t>> reads_;  // shape, lights, η, shadows
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

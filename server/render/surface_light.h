// Technique `integral`, the half that needs no GL: from a placed mesh and lights to the radiosity of every vertex.
#pragma once

#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "diffusion/dipole_integral.h"
#include "render/irradiance.h"
#include "render/memo.h"
#include "render/refined_mesh.h"
#include "render/stage_clock.h"

namespace diaphane::render {

/// Light on one mesh. Stages: normals, refit, irradiance, flux, gather; each sleeps while what it reads is the same.
/// One thread calls; work is spread over all cores. The same bytes on any number of threads.
class SurfaceLight {
 public:
  struct Inputs {
    RefinedMesh& mesh;  ///< gets its normals here
    std::span<const LightStorage> lights;
    const Ambient& ambient;
    const optics::Coefficients& material;
    diffusion::Quality quality;
    ShadowScene* shadows;         ///< null: unshadowed
    uint64_t shadows_generation;  ///< of what casts them; 0 without
  };

  void update(const Inputs& inputs, StageClock& clock);

  /// B, RGB, W·mm⁻², a value a vertex. Valid until the next update.
  std::span<const glm::vec3> radiosity() const { return radiosity_; }
  /// E of the last update, at triangles and vertices.
  const SurfaceIrradiance& irradiance() const { return irradiance_.result(); }
  /// Grows whenever irradiance changes.
  uint64_t irradiance_generation() const { return irradiance_generation_; }
  /// Memory that the integral holds.
  size_t bytes() const { return integral_ == nullptr ? 0 : integral_->bytes(); }
  /// Grows whenever radiosity changes.
  uint64_t generation() const { return generation_; }

 private:
  std::unique_ptr<diffusion::DipoleIntegral> integral_;
  IrradianceStage irradiance_;
  std::vector<glm::vec3> radiosity_;
  uint64_t irradiance_generation_ = 0;
  uint64_t generation_ = 0;

  // What each stage reads, in the order in which they run.
  Memo<uint64_t> refit_reads_;  // shape
  // shape, lights, what is around, η, shadows
  Memo<std::tuple<uint64_t, std::vector<LightStorage>, Ambient, float, uint64_t>> light_reads_;
  Memo<std::tuple<uint64_t, uint64_t>> flux_reads_;  // shape, irradiance
  Memo<optics::Coefficients> material_reads_;
  Memo<std::tuple<uint64_t, uint64_t, optics::Coefficients, diffusion::Quality>>
      gather_reads_;  // shape, irradiance, material, quality
};

}  // namespace diaphane::render

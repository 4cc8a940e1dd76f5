// Technique `integral`, the half that needs no GL: from a placed mesh and lights to the radiosity of every vertex.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "diffusion/dipole_integral.h"
#include "render/irradiance.h"
#include "render/memo.h"
#include "render/refined_mesh.h"
#include "render/slab_correction.h"
#include "render/stage_clock.h"
#include "render/thickness.h"

namespace diaphane::render {

/// Light on one mesh. Stages: normals, refit, occlusion (where asked for), irradiance, flux, gather, slab (where asked
/// for); each sleeps while what it reads is the same. One thread calls; work is spread over all cores. The same bytes
/// on any number of threads.
class SurfaceLight {
 public:
  struct Inputs {
    RefinedMesh& mesh;  ///< gets its normals here
    std::span<const LightStorage> lights;
    const Ambient& ambient;
    const optics::Coefficients& material;
    diffusion::Quality quality;
    ShadowScene* shadows;         ///< null: unshadowed
    ShadowScene* occluders;       ///< null: nothing hides what is around
    uint64_t shadows_generation;  ///< of what casts either; 0 without
    bool slab_correction = false;
  };

  void update(const Inputs& inputs, StageClock& clock);

  /// B, RGB, W·mm⁻², a value a vertex. Valid until the next update.
  std::span<const glm::vec3> radiosity() const { return corrects_ ? corrected_ : radiosity_; }
  /// E of the last update, at triangles and vertices.
  const SurfaceIrradiance& irradiance() const { return irradiance_.result(); }
  /// Grows whenever irradiance changes.
  uint64_t irradiance_generation() const { return irradiance_generation_; }
  /// Memory that the integral and the slabs' rays hold.
  size_t bytes() const;
  /// Grows whenever radiosity changes.
  uint64_t generation() const { return generation_; }

 private:
  std::unique_ptr<diffusion::DipoleIntegral> integral_;
  IrradianceStage irradiance_;
  AmbientOcclusion occlusion_;
  std::vector<glm::vec3> radiosity_;
  void correct_slabs_of(const Inputs& inputs, StageClock& clock);

  bool corrects_ = false;
  std::vector<glm::vec3> corrected_;
  std::unique_ptr<ThicknessField> thickness_;
  std::vector<OppositePoint> opposites_;
  std::optional<SlabGains> gains_;
  uint64_t irradiance_generation_ = 0;
  uint64_t generation_ = 0;
  uint64_t gather_generation_ = 0;

  // What each stage reads, in the order in which they run.
  Memo<uint64_t> refit_reads_;  // shape
  // shape, lights, what is around, η, shadows
  using LightKey = std::tuple<uint64_t, std::vector<LightStorage>, Ambient, float, uint64_t>;
  Memo<LightKey> light_reads_;
  LightKey light_key_;                                    // of this frame, in the memory of the last
  Memo<std::tuple<uint64_t, uint64_t>> flux_reads_;       // shape, irradiance
  Memo<std::tuple<uint64_t, uint64_t>> occlusion_reads_;  // shape, occluders
  Memo<optics::Coefficients> material_reads_;
  Memo<uint64_t> opposite_reads_;  // shape
  Memo<optics::Coefficients> gain_reads_;
  Memo<std::tuple<uint64_t, optics::Coefficients, bool>> slab_reads_;  // gathered radiosity, material, asked for
  Memo<std::tuple<uint64_t, uint64_t, optics::Coefficients, diffusion::Quality>>
      gather_reads_;  // shape, irradiance, material, quality
};

}  // namespace diaphane::render

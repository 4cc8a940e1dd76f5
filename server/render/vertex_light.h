// E with shadows and of what is around, for techniques whose shaders would find it without.
#pragma once

#include <span>
#include <tuple>
#include <vector>

#include "geometry/shape.h"
#include "geometry/topology.h"
#include "render/ambient.h"
#include "render/ambient_occlusion.h"
#include "render/memo.h"
#include "render/shadow.h"
#include "render/stage_clock.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// Light on one mesh at its vertices. With shadows, a ray from each to each light that it faces. Stage:
/// irradiance; it sleeps while what it reads is the same. One thread calls; work is spread over all cores. The same
/// bytes on any number of threads.
class VertexLight {
 public:
  struct Inputs {
    const geometry::MeshTopology& topology;
    const geometry::PlacedShape& shape;
    uint64_t generation;  ///< of both
    std::span<const LightStorage> lights;
    const Ambient& ambient;
    float refractive_index;  ///< 1: E without Fresnel
    ShadowScene* shadows;    ///< null: unshadowed
    ShadowScene* occluders;  ///< null: nothing hides what is around
    uint64_t shadows_generation;
  };

  void update(const Inputs& inputs, StageClock& clock);

  /// E, RGB, W·mm⁻², a value a vertex. Valid until the next update.
  std::span<const glm::vec3> irradiance() const { return irradiance_; }
  /// The lights, with the share of each one's power that shadows leave the mesh in shape.z (see lights.glsl).
  std::span<const LightStorage> lights() const { return lights_; }
  /// Above 0, and grows whenever irradiance or lights change.
  uint64_t generation() const { return generation_; }
  size_t bytes() const { return irradiance_.capacity() * sizeof(glm::vec3) + occlusion_.bytes(); }

 private:
  /// Takes from what is around what bodies hide.
  void occlude(const Inputs& inputs);
  /// Adds what one light gives, and returns the share of its power that shadows leave.
  float add(const LightStorage& light, const Inputs& inputs);

  struct Arrival {
    glm::vec3 entering;
    float seen;
  };
  std::vector<Arrival> arrivals_;
  std::vector<float> areas_mm2_;
  AmbientOcclusion occlusion_;
  std::vector<glm::vec3> irradiance_;
  std::vector<LightStorage> lights_;
  // shape, lights, what is around, η, shadows
  using Key = std::tuple<uint64_t, std::vector<LightStorage>, Ambient, float, uint64_t>;
  Memo<Key> reads_;
  Key key_;  // of this frame, in the memory of the last
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

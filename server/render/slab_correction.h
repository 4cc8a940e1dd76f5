// Option slab_correction: of what the surface integral says of thin parts, what a slab gives.
#pragma once

#include <span>
#include <vector>

#include "glm/vec3.hpp"
#include "optics/slab.h"
#include "render/thickness.h"

namespace diaphane::render {

/// optics::slab_gain() of one material, by thickness. A table, steps of a hundredth in ln d. Thread-safe once made.
class SlabGains {
 public:
  explicit SlabGains(const optics::Coefficients& material);
  /// 1 and 0 for an infinite thickness.
  optics::SlabGain at(float thickness_mm) const;

 private:
  float first_mm_, last_mm_;
  std::vector<optics::SlabGain> gains_;
};

/// The mean over a point's `opposites` of own·here + opposite·there, not below 0; `there` has as many radiosities.
/// Less is corrected the less parallel the walls are: where they are at 80° and more to each other, nothing.
glm::vec3 slab_corrected(const SlabGains& gains, std::span<const OppositePoint> opposites, const glm::vec3& here,
                         std::span<const glm::vec3> there);

/// Corrects the radiosities at vertices of a mesh: `opposites` are ThicknessField::find() of them, `corrected` gets a
/// value a vertex. Over all cores.
void correct_slabs(const SlabGains& gains, std::span<const OppositePoint> opposites,
                   std::span<const glm::uvec3> triangles, std::span<const glm::vec3> radiosity,
                   std::span<glm::vec3> corrected);

}  // namespace diaphane::render

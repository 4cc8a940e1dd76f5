// Option slab_correction: of what the surface integral says of thin parts, what a slab gives.
#pragma once

#include <span>
#include <vector>

#include "glm/vec3.hpp"
#include "optics/slab.h"
#include "render/thickness.h"

namespace diaphane::render {

/// optics::Slab::gain() of one material, by thickness. A table, steps of a hundredth in ln d. Thread-safe once made.
class SlabGains {
 public:
  explicit SlabGains(const optics::Coefficients& material);
  /// The half-space's for an infinite thickness.
  optics::SlabGain at(float thickness_mm) const;
  /// Of an infinite thickness, times B here alone.
  const glm::vec3& half_space() const { return half_space_; }

 private:
  float first_mm_, last_mm_;
  glm::vec3 half_space_;
  std::vector<optics::SlabGain> gains_;
};

/// The mean over a point's `opposites` of own·here + opposite·there, not below 0; `there` has as many radiosities.
/// The less parallel the walls are, the more it is the half-space's: all of it where they are at 80° and more to each
/// other.
glm::vec3 slab_corrected(const SlabGains& gains, std::span<const OppositePoint> opposites, const glm::vec3& here,
                         std::span<const glm::vec3> there);

/// Corrects the radiosities at vertices of a mesh: `opposites` are ThicknessField::find() of them, `corrected` gets a
/// value a vertex. Over all cores.
void correct_slabs(const SlabGains& gains, std::span<const OppositePoint> opposites,
                   std::span<const glm::uvec3> triangles, std::span<const glm::vec3> radiosity,
                   std::span<glm::vec3> corrected);

}  // namespace diaphane::render

#include "render/slab_correction.h"

#include <algorithm>
#include <cmath>

#include "glm/common.hpp"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr float kSteps = 100;  ///< a factor of e

/// In mean free paths: below, faces do not differ; above, a slab is as good as a half-space, or as good as any that
/// absorbs nothing, whose far face tells at 1/d.
constexpr float kThinnest = 0.02f, kThickest = 2000;

}  // namespace

SlabGains::SlabGains(const optics::Coefficients& material) {
  const glm::vec3 extinction = material.absorption_mm + material.reduced_scattering_mm;
  first_mm_ = kThinnest / std::max({extinction.x, extinction.y, extinction.z});
  last_mm_ = kThickest / std::min({extinction.x, extinction.y, extinction.z});
  const auto count = static_cast<size_t>(std::ceil(kSteps * std::log(last_mm_ / first_mm_))) + 2;
  for (size_t i = 0; i < count; ++i) {
    gains_.push_back(optics::slab_gain(material, double{first_mm_} * std::exp(static_cast<double>(i) / kSteps)));
  }
}

optics::SlabGain SlabGains::at(float thickness_mm) const {
  if (!(thickness_mm < last_mm_)) return {};
  const float at = kSteps * std::log(std::max(thickness_mm, first_mm_) / first_mm_);
  const size_t step = std::min(static_cast<size_t>(at), gains_.size() - 2);
  const float share = at - static_cast<float>(step);
  const optics::SlabGain &low = gains_[step], &high = gains_[step + 1];
  return {glm::mix(low.own, high.own, share), glm::mix(low.opposite, high.opposite, share)};
}

glm::vec3 slab_corrected(const optics::SlabGain& gain, const glm::vec3& here, const glm::vec3& there) {
  return glm::max(gain.own * here + gain.opposite * there, glm::vec3(0));
}

void correct_slabs(const SlabGains& gains, std::span<const OppositePoint> opposites,
                   std::span<const glm::uvec3> triangles, std::span<const glm::vec3> radiosity,
                   std::span<glm::vec3> corrected) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, opposites.size(), 1024),
                    [&](const tbb::blocked_range<size_t>& range) {
                      for (size_t v = range.begin(); v != range.end(); ++v) {
                        const OppositePoint& opposite = opposites[v];
                        const glm::uvec3& t = triangles[opposite.triangle];
                        const glm::vec3 there = opposite.weights.x * radiosity[t.x] +
                                                opposite.weights.y * radiosity[t.y] +
                                                opposite.weights.z * radiosity[t.z];
                        corrected[v] = slab_corrected(gains.at(opposite.thickness_mm), radiosity[v], there);
                      }
                    });
}

}  // namespace diaphane::render

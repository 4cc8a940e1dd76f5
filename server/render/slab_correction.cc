#include "render/slab_correction.h"

#include <algorithm>
#include <array>
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

/// Cosines between walls that count as a slab's not at all, and whole.
constexpr float kApart = 0.17f, kParallel = 0.87f;

}  // namespace

SlabGains::SlabGains(const optics::Coefficients& material) {
  const glm::vec3 extinction = material.absorption_mm + material.reduced_scattering_mm;
  first_mm_ = kThinnest / std::max({extinction.x, extinction.y, extinction.z});
  last_mm_ = kThickest / std::min({extinction.x, extinction.y, extinction.z});
  const auto count = static_cast<size_t>(std::ceil(kSteps * std::log(last_mm_ / first_mm_))) + 2;
  const optics::Slab slab(material);
  half_space_ = slab.gain(1e6 * double{last_mm_}).own;
  for (size_t i = 0; i < count; ++i) {
    gains_.push_back(slab.gain(double{first_mm_} * std::exp(static_cast<double>(i) / kSteps)));
  }
}

optics::SlabGain SlabGains::at(float thickness_mm) const {
  if (!(thickness_mm < last_mm_)) return {half_space_, glm::vec3(0)};
  const float at = kSteps * std::log(std::max(thickness_mm, first_mm_) / first_mm_);
  const size_t step = std::min(static_cast<size_t>(at), gains_.size() - 2);
  const float share = at - static_cast<float>(step);
  const optics::SlabGain &low = gains_[step], &high = gains_[step + 1];
  return {glm::mix(low.own, high.own, share), glm::mix(low.opposite, high.opposite, share)};
}

glm::vec3 slab_corrected(const SlabGains& gains, std::span<const OppositePoint> opposites, const glm::vec3& here,
                         std::span<const glm::vec3> there) {
  glm::vec3 sum(0);
  for (size_t i = 0; i < opposites.size(); ++i) {
    const optics::SlabGain gain = gains.at(opposites[i].thickness_mm);
    const float share = glm::smoothstep(kApart, kParallel, opposites[i].facing);
    sum += glm::mix(gains.half_space(), gain.own, share) * here + share * gain.opposite * there[i];
  }
  return glm::max(sum / static_cast<float>(opposites.size()), glm::vec3(0));
}

void correct_slabs(const SlabGains& gains, std::span<const OppositePoint> opposites,
                   std::span<const glm::uvec3> triangles, std::span<const glm::vec3> radiosity,
                   std::span<glm::vec3> corrected) {
  constexpr size_t kRays = ThicknessField::kRays;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, corrected.size(), 1024),
                    [&](const tbb::blocked_range<size_t>& range) {
                      std::array<glm::vec3, kRays> there;
                      for (size_t v = range.begin(); v != range.end(); ++v) {
                        const auto own = opposites.subspan(kRays * v, kRays);
                        for (size_t i = 0; i < kRays; ++i) there[i] = own[i].of(triangles, radiosity);
                        corrected[v] = slab_corrected(gains, own, radiosity[v], there);
                      }
                    });
}

}  // namespace diaphane::render

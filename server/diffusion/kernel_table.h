// Rd and its derivatives as tables small enough to be looked up from registers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "diffusion/node_tree.h"
#include "glm/vec3.hpp"
#include "optics/profile.h"

namespace diaphane::diffusion {

/// f(r²) and its first two derivatives in r².
struct KernelValue {
  double value = 0, first = 0, second = 0;
};

/// z of each channel, mm: the distance on which its kernel is smooth.
glm::vec3 smooth_distance_mm(const optics::ReflectanceProfile& profile);

/// Σ w_k e^(−r²/2σ_k²), σ_k rising from 0.4 z: Rd of one channel, with which its narrow part can be taken out.
struct GaussianSum {
  std::vector<double> deviation_mm;
  std::vector<double> weight;  ///< ≥ 0

  KernelValue at(double distance2_mm2) const;
  double total() const;  ///< over the plane
};
/// A fit to a dipole's Rd. For normalized diffusion, whose e^(−ar)/r is a mixture of Gaussians of every width, the part
/// of that mixture from σ_0 up.
GaussianSum fit_gaussians(const optics::ChannelProfile& profile);

/// What of Rd vertices can carry at all: all of a dipole's. Normalized diffusion is infinite at r = 0; there it is
/// fit_gaussians(), and what is narrower is left to the local term.
KernelValue carried_kernel(const optics::ChannelProfile& profile, const GaussianSum& gaussians, double distance2_mm2);

/// With v = √(scale·r² + 4), clamped to 2..512: f·v³, f′·v⁵ and f″·v⁷ of each channel are cubics in v on eight segments
/// of one octave each; the segment is the low three bits of v's exponent. (In v, not v²: the nearest singularity of
/// what is interpolated is twice as far away, the error fourteen times smaller.)
struct alignas(64) KernelTable {
  static constexpr int kSegments = 8;
  static constexpr int kCoefficients = 4;
  float coefficient[3][3][kCoefficients][kSegments];  ///< [derivative][channel][power of v][segment]
};

/// Which r² the tables of a body cover.
struct KernelDomain {
  static constexpr float kSmallest = 2;  ///< v at r = 0
  static constexpr float kLargest = 511.999f;
  float scale = 1;  ///< mm⁻²
};

/// Every table that a body of one material needs. Not thread-safe while prepare() runs.
class KernelSet {
 public:
  /// Starts over with a material.
  void set_material(const optics::Coefficients& material);
  /// Builds what is missing for a body of `diameter_mm` whose leaves have the spacings s² `spacing2_mm2`.
  void prepare(float diameter_mm, const std::vector<float>& spacing2_mm2);

  const KernelDomain& domain() const { return domain_; }
  const KernelTable& far_table() const { return far_; }
  /// Rd without what is narrower than a step's spacing.
  const KernelTable& near_table(uint32_t step) const { return *near_[step]; }
  /// What near_table leaves out, integrated over the plane: times the local irradiance it is radiosity.
  glm::vec3 local_response(const SpacingPosition& at) const {
    return local_response_[at.step] + at.share * (local_response_[at.step + 1u] - local_response_[at.step]);
  }
  /// The smallest smooth distance of the channels, mm.
  float smooth_mm() const { return smooth_mm_; }

 private:
  void build(uint32_t step);

  optics::ReflectanceProfile profile_;
  std::array<GaussianSum, 3> gaussians_;
  glm::vec3 narrow_response_{0};  ///< of what no vertices carry
  float smooth_mm_ = 1;
  float diameter_mm_ = 0;
  KernelDomain domain_;
  KernelTable far_;
  std::array<const KernelTable*, kSpacingSteps> near_{};
  std::array<glm::vec3, kSpacingSteps> local_response_{};
  std::array<std::unique_ptr<KernelTable>, kSpacingSteps> built_;
};

}  // namespace diaphane::diffusion

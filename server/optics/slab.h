// What thin bodies give back: radiative transfer's slab, beside what a profile says of one.
#pragma once

#include <array>

#include "glm/vec3.hpp"
#include "optics/profile.h"
#include "optics/slab_transport.h"

namespace diaphane::optics {

/// Shares of the light that enters a slab evenly through one face, which leave it after scattering.
struct SlabResponse {
  glm::dvec3 reflected{0};    ///< R, through the same face
  glm::dvec3 transmitted{0};  ///< T, through the other
};

/// How to make of an integral's radiosities B here and B' at the opposite point what a slab gives:
/// own·B + opposite·B'. Exact where light enters evenly through each face, by any share.
struct SlabGain {
  glm::vec3 own{1}, opposite{0};
};

/// The slab of one material by radiative transfer, its reduced coefficients taken for isotropic scattering, under light
/// that enters along the normal (diffusion theory's own slab is as good where little is absorbed, and 10 % and more
/// too bright where much is). Immutable.
class Slab {
 public:
  explicit Slab(const Coefficients& material);

  /// Of thickness d ≥ 0 in mm.
  SlabResponse response(double thickness_mm) const;
  /// Far apart: what radiative transfer's half-space reflects over total_reflectance(), and 0.
  SlabGain gain(double thickness_mm) const;

 private:
  Coefficients material_;
  std::array<TransportSlab, 3> channels_;
};

/// What the surface integral says of the same slab: total_reflectance() through the same face, whatever the thickness,
/// and through the other ∫ Rd(√(r² + d²)) dA.
SlabResponse integral_slab_response(const Coefficients& material, double thickness_mm);

}  // namespace diaphane::optics

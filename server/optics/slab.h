// What thin bodies give back: diffusion theory's slab, beside what a profile says of one.
#pragma once

#include "glm/vec3.hpp"
#include "optics/profile.h"

namespace diaphane::optics {

/// Shares of the light that enters a slab evenly through one face, which leave it after scattering.
struct SlabResponse {
  glm::dvec3 reflected{0};    ///< R, through the same face
  glm::dvec3 transmitted{0};  ///< T, through the other
};

/// Diffusion theory's slab of thickness d ≥ 0 in mm: G of −Dφ″ + σaφ = q between the boundaries extrapolated by
/// z_b = 2AD, in closed form, under light that enters along the normal. Its source is spread along the way,
/// q = α'e^(−z/l)/l, instead of lying at z = l, so that it stays inside where the slab is thinner than that;
/// what reaches the far face is reflected there once, by Fresnel at normal incidence. Scaled so that a thick slab
/// reflects total_reflectance() of the material's profile. Thread-safe.
SlabResponse slab_response(const Coefficients& material, double thickness_mm);

/// What the surface integral says of the same slab: total_reflectance() through the same face, whatever the thickness,
/// and through the other ∫ Rd(√(r² + d²)) dA.
SlabResponse integral_slab_response(const Coefficients& material, double thickness_mm);

/// How to make of an integral's radiosities B here and B' at the opposite point what a slab gives:
/// own·B + opposite·B'. Exact where light enters evenly through each face, by any share; 1 and 0 far apart.
struct SlabGain {
  glm::vec3 own{1}, opposite{0};
};
SlabGain slab_gain(const Coefficients& material, double thickness_mm);

}  // namespace diaphane::optics

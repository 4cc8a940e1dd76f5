// Reflectance profiles Rd(r): the classical dipole and what the field uses beside it, in one form.
#pragma once

#include <array>

#include "glm/vec3.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {

/// (flux (1 + σd)/d³ + fluence/d) e^(−σd), d = √(r² + height²): one source's share of Rd. Over the plane it is
/// 2π (flux/height + fluence/σ) e^(−σ height), with 0 for flux/height at height 0.
struct ProfileTerm {
  double height_mm = 0;
  double transport_mm = 0;  ///< σ, mm⁻¹
  double flux_mm = 0;       ///< what the net flux brings, mm
  double fluence_mm = 0;    ///< what the fluence brings, mm⁻¹
};

/// Rd of one channel: a sum of two terms.
struct ChannelProfile {
  std::array<ProfileTerm, 2> terms;
  double total = 0;      ///< ∫ Rd dA over the plane
  double smooth_mm = 0;  ///< z, the distance on which Rd is smooth
};
using ReflectanceProfile = std::array<ChannelProfile, 3>;

/// Rd of `material` by its profile:
/// - the dipole of JMLH01;
/// - the better dipole of d'Eon 2012: Grosjean's diffusion coefficient, and both fluence and flux at the boundary;
/// - normalized diffusion of Christensen and Burley 2015, A s/(8πlr) (e^(−sr/l) + e^(−sr/3l)), its s for diffuse light
///   on the surface. A is the dipole's total of these coefficients, so that both have one colour. Infinite at r = 0.
/// Thread-safe.
ReflectanceProfile make_profile(const Coefficients& material);

/// Rd(r) in mm⁻², r ≥ 0 the straight-line distance in mm (above 0 for normalized diffusion).
glm::vec3 diffuse_reflectance(const ReflectanceProfile& profile, float distance_mm);

/// ∫ Rd dA over the plane: the share of a uniform irradiance that a half-space of `material` gives back.
glm::vec3 total_reflectance(const Coefficients& material);

/// The same for one channel that absorbs the share `absorbed` = 1 − α' at each event, 0..1; falls as it grows.
double total_reflectance(Profile profile, double absorbed, double refractive_index);

/// ∫₀¹ μⁿ F(μ) dμ, n = 1 or 2, of the Fresnel reflectance F for light that meets the boundary from inside at the cosine
/// μ; n = 1 times two is what diffuse_fresnel_reflectance() fits.
double fresnel_moment(int order, double refractive_index);

}  // namespace diaphane::optics

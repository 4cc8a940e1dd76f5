// The classical dipole of JMLH01 in the form of JB02, for three channels.
#pragma once

#include "glm/vec3.hpp"

namespace diaphane::optics {

/// How light spreads below the surface; optics/profile.h has their formulae.
enum class Profile { kDipole, kBetterDipole, kNormalizedDiffusion };

/// What a body is made of. Absorption σa ≥ 0 and reduced scattering σ's > 0 in mm⁻¹, linear RGB; η is the ratio of
/// refractive indices, inside over outside, 1..3.
struct Coefficients {
  glm::vec3 absorption_mm{0};
  glm::vec3 reduced_scattering_mm{1};
  float refractive_index = 1.3f;
  Profile profile = Profile::kDipole;

  friend bool operator==(const Coefficients&, const Coefficients&) = default;
};

/// The dipole's constants for one material, per channel, in mm and mm⁻¹.
/// zv = zr + 4AD: the paper's Table 1 has zr(1 + 4AD), whose dimensions do not agree.
struct Dipole {
  glm::vec3 mean_free_path_mm{0};       ///< l = 1/σ't, also zr, the depth of the real source
  glm::vec3 virtual_height_mm{0};       ///< zv, the height of the virtual source
  glm::vec3 effective_transport_mm{0};  ///< σ = √(3 σa σ't), mm⁻¹
  glm::vec3 reduced_albedo{0};          ///< α' = σ's/σ't
};

/// Constants of `material`. Thread-safe.
Dipole make_dipole(const Coefficients& material);

/// Rd(r) in mm⁻², r ≥ 0 the straight-line distance in mm. JB02, with distances √(r² + z²).
glm::vec3 diffuse_reflectance(const Dipole& dipole, float distance_mm);

/// A = (1 + Fdr)/(1 − Fdr): what the mismatched boundary sends back, η ≥ 1.
float boundary_mismatch(float refractive_index);

/// Average diffuse Fresnel reflectance Fdr inside a body of refractive index η ≥ 1; 0 at η = 1.
float diffuse_fresnel_reflectance(float refractive_index);

/// Unpolarised Fresnel transmittance 1 − R from outside into η at the cosine of incidence, 0..1.
float fresnel_transmittance(float refractive_index, float cosine);

}  // namespace diaphane::optics

// Real spherical harmonics up to band 4, and light from all around in them.
#pragma once

#include <array>
#include <cstddef>

#include "glm/vec3.hpp"

namespace diaphane::optics {

inline constexpr size_t kHarmonicBands = 5;
inline constexpr size_t kHarmonics = 25;  ///< by band, and within one by order −l..l

/// The polynomials of the real harmonics at a unit direction, without their constants; kHarmonicNorms has these
/// squared. `Number` is any type with arithmetic of its own and with double.
template <typename Number, typename Scalar>
void harmonic_polynomials(const Number& x, const Number& y, const Number& z, Number (&p)[kHarmonics]) {
  const Number xx = x * x, yy = y * y, zz = z * z;
  const Number difference = xx - yy, xy = x * y, yz = y * z, xz = x * z;
  const auto k = [](double value) { return static_cast<Scalar>(value); };
  p[0] = xx + yy + zz;
  p[1] = y;
  p[2] = z;
  p[3] = x;
  p[4] = xy;
  p[5] = yz;
  p[6] = k(3) * zz - k(1);
  p[7] = xz;
  p[8] = difference;
  p[9] = y * (k(3) * xx - yy);
  p[10] = xy * z;
  p[11] = y * (k(5) * zz - k(1));
  p[12] = z * (k(5) * zz - k(3));
  p[13] = x * (k(5) * zz - k(1));
  p[14] = z * difference;
  p[15] = x * (xx - k(3) * yy);
  p[16] = xy * difference;
  p[17] = yz * (k(3) * xx - yy);
  p[18] = xy * (k(7) * zz - k(1));
  p[19] = yz * (k(7) * zz - k(3));
  p[20] = zz * (k(35) * zz - k(30)) + k(3);
  p[21] = xz * (k(7) * zz - k(3));
  p[22] = difference * (k(7) * zz - k(1));
  p[23] = xz * (xx - k(3) * yy);
  p[24] = xx * (xx - k(3) * yy) - yy * (k(3) * xx - yy);
}

/// The square of each harmonic's constant: what its polynomial is multiplied by, once for the projection and once for
/// the value.
const std::array<double, kHarmonics>& harmonic_norms();

/// Â_l = 2π ∫₀¹ P_l(μ) μ Ft(η, μ) dμ: what a clamped cosine and the way into a body of index η make of band l. η = 1:
/// the cosine alone.
std::array<float, kHarmonicBands> entering_bands(float refractive_index);

/// ∫ L p dω for each polynomial, RGB.
using Harmonics = std::array<glm::vec3, kHarmonics>;

/// What the polynomials at a normal N are multiplied by so that their sum is E(N) = Σ Â_l L_lm Y_lm(N), Fresnel inside.
Harmonics irradiance_harmonics(const Harmonics& radiance, float refractive_index);

/// Σ harmonics · polynomials, at a unit direction.
glm::vec3 evaluate(const Harmonics& harmonics, const glm::vec3& direction);

}  // namespace diaphane::optics

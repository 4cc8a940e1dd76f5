#include "optics/harmonics.h"

#include <cmath>
#include <numbers>

#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

size_t band_of(size_t harmonic) { return static_cast<size_t>(std::sqrt(static_cast<double>(harmonic))); }

double legendre(size_t band, double mu) {
  double before = 1, now = mu;
  if (band == 0) return before;
  for (size_t l = 2; l <= band; ++l) {
    const auto n = static_cast<double>(l);
    const double next = ((2 * n - 1) * mu * now - (n - 1) * before) / n;
    before = now;
    now = next;
  }
  return now;
}

}  // namespace

const std::array<double, kHarmonics>& harmonic_norms() {
  static const std::array<double, kHarmonics> kNorms = [] {
    constexpr double kPi = std::numbers::pi;
    // Numerators of K² = n / π.
    constexpr double kOverPi[kHarmonics] = {
        1.0 / 4,   3.0 / 4,   3.0 / 4,   3.0 / 4,   15.0 / 4,  15.0 / 4,   5.0 / 16,   15.0 / 4,   15.0 / 16,
        35.0 / 32, 105.0 / 4, 21.0 / 32, 7.0 / 16,  21.0 / 32, 105.0 / 16, 35.0 / 32,  315.0 / 16, 315.0 / 32,
        45.0 / 16, 45.0 / 32, 9.0 / 256, 45.0 / 32, 45.0 / 64, 315.0 / 32, 315.0 / 256};
    std::array<double, kHarmonics> norms;
    for (size_t i = 0; i < kHarmonics; ++i) norms[i] = kOverPi[i] / kPi;
    return norms;
  }();
  return kNorms;
}

std::array<float, kHarmonicBands> entering_bands(float refractive_index) {
  constexpr int kSteps = 2000;
  std::array<double, kHarmonicBands> sums{};
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    const double weight = mu * fresnel_transmittance(refractive_index, static_cast<float>(mu)) / kSteps;
    for (size_t l = 0; l < kHarmonicBands; ++l) sums[l] += legendre(l, mu) * weight;
  }
  std::array<float, kHarmonicBands> bands;
  for (size_t l = 0; l < kHarmonicBands; ++l) bands[l] = static_cast<float>(2 * std::numbers::pi * sums[l]);
  return bands;
}

Harmonics irradiance_harmonics(const Harmonics& radiance, float refractive_index) {
  const std::array<float, kHarmonicBands> bands = entering_bands(refractive_index);
  Harmonics irradiance;
  for (size_t i = 0; i < kHarmonics; ++i) {
    irradiance[i] = bands[band_of(i)] * static_cast<float>(harmonic_norms()[i]) * radiance[i];
  }
  return irradiance;
}

glm::vec3 evaluate(const Harmonics& harmonics, const glm::vec3& direction) {
  float p[kHarmonics];
  harmonic_polynomials<float, float>(direction.x, direction.y, direction.z, p);
  glm::vec3 sum(0);
  for (size_t i = 0; i < kHarmonics; ++i) sum += p[i] * harmonics[i];
  return sum;
}

}  // namespace diaphane::optics

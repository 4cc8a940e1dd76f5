#include "optics/dipole.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"
#include "glm/exponential.hpp"

namespace diaphane::optics {
namespace {

/// One source's share of 4π Rd/α': z (1 + σd) e^(−σd)/d³.
float source_term(float height_mm, float transport_mm, float distance_mm) {
  const float d = std::sqrt(distance_mm * distance_mm + height_mm * height_mm);
  return height_mm * (1 + transport_mm * d) * std::exp(-transport_mm * d) / (d * d * d);
}

}  // namespace

float boundary_mismatch(float refractive_index) {
  const float reflectance = diffuse_fresnel_reflectance(refractive_index);
  return (1 + reflectance) / (1 - reflectance);
}

float diffuse_fresnel_reflectance(float refractive_index) {
  if (refractive_index <= 1) return 0;
  const float eta = refractive_index;
  return -1.440f / (eta * eta) + 0.710f / eta + 0.668f + 0.0636f * eta;
}

float fresnel_transmittance(float refractive_index, float cosine) {
  const float c = std::clamp(cosine, 0.0f, 1.0f);
  const float inside = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (refractive_index * refractive_index)));
  const float denominator_s = c + refractive_index * inside;
  const float denominator_p = inside + refractive_index * c;
  const float s = (c - refractive_index * inside) / denominator_s;
  const float p = (inside - refractive_index * c) / denominator_p;
  return 1 - 0.5f * (s * s + p * p);
}

Dipole make_dipole(const Coefficients& material) {
  Dipole dipole;
  const glm::vec3 extinction = material.absorption_mm + material.reduced_scattering_mm;
  dipole.mean_free_path_mm = 1.0f / extinction;
  dipole.reduced_albedo = material.reduced_scattering_mm / extinction;
  dipole.effective_transport_mm = glm::sqrt(3.0f * material.absorption_mm * extinction);
  const float mismatch = boundary_mismatch(material.refractive_index);
  // 4AD with D = 1/(3σ't) = l/3.
  dipole.virtual_height_mm = dipole.mean_free_path_mm * (1 + 4 * mismatch / 3);
  return dipole;
}

glm::vec3 diffuse_reflectance(const Dipole& dipole, float distance_mm) {
  glm::vec3 rd;
  for (int c = 0; c < 3; ++c) {
    const float transport = dipole.effective_transport_mm[c];
    rd[c] = dipole.reduced_albedo[c] /
            (4 * std::numbers::pi_v<float>)*(source_term(dipole.mean_free_path_mm[c], transport, distance_mm) +
                                             source_term(dipole.virtual_height_mm[c], transport, distance_mm));
  }
  return rd;
}

}  // namespace diaphane::optics

#include "optics/slab.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"

namespace diaphane::optics {
namespace {

struct Shares {
  double reflected, transmitted;
};

/// One channel of unit mean free path: σa = `absorbed`, σ's = 1 − `absorbed`, thickness in mean free paths.
Shares diffusion_slab(double absorbed, double mismatch, double face_reflectance, double thickness) {
  const double extrapolated = 2 * mismatch / 3;
  const double length = thickness + 2 * extrapolated;
  // Nothing changes below, and 0 has no closed form.
  const double transport = std::max(std::sqrt(3 * absorbed), 1e-5 / length);
  const double falls = std::exp(-transport * thickness), beam = std::exp(-thickness);
  const double far = std::exp(-transport * length);
  // ∫ e^(−z) e^(−σz) dz over the slab, and e^(−σd) ∫ e^(−z) e^(σz) dz.
  const double towards = (1 - falls * beam) / (1 + transport);
  const double away = std::abs(1 - transport) * thickness > 1e-6 ? (falls - beam) / (1 - transport) : thickness * beam;
  const double scale = (1 - absorbed) * 0.5 * (1 + std::exp(-2 * transport * extrapolated)) / (1 - far * far);
  const Shares once{scale * (towards - far * away), scale * (away - far * towards)};
  const double turned = face_reflectance * beam;
  return {once.reflected + turned * once.transmitted, once.transmitted + turned * once.reflected};
}

}  // namespace

SlabResponse slab_response(const Coefficients& material, double thickness_mm) {
  const glm::vec3 total = total_reflectance(material);
  const double mismatch = boundary_mismatch(material.refractive_index);
  const double face_reflectance = 1 - double{fresnel_transmittance(material.refractive_index, 1)};
  SlabResponse slab;
  for (int c = 0; c < 3; ++c) {
    const double absorption = material.absorption_mm[c];
    const double extinction = absorption + double{material.reduced_scattering_mm[c]};
    const double absorbed = absorption / extinction, transport = std::sqrt(3 * absorbed);
    const Shares shares = diffusion_slab(absorbed, mismatch, face_reflectance, thickness_mm * extinction);
    const double thick = (1 - absorbed) * 0.5 * (1 + std::exp(-4.0 / 3.0 * mismatch * transport)) / (1 + transport);
    slab.reflected[c] = shares.reflected * total[c] / thick;
    slab.transmitted[c] = shares.transmitted * total[c] / thick;
  }
  return slab;
}

SlabResponse integral_slab_response(const Coefficients& material, double thickness_mm) {
  const ReflectanceProfile profile = make_profile(material);
  SlabResponse slab;
  for (int c = 0; c < 3; ++c) {
    const ChannelProfile& channel = profile[static_cast<size_t>(c)];
    slab.reflected[c] = channel.total;
    // Where nothing is absorbed, what the two terms' fluences differ by.
    double fluence = 0;
    const ProfileTerm& first = channel.terms[0];
    for (const ProfileTerm& term : channel.terms) {
      const double d = std::hypot(term.height_mm, thickness_mm), fall = std::exp(-term.transport_mm * d);
      if (term.flux_mm > 0) slab.transmitted[c] += 2 * std::numbers::pi * term.flux_mm * fall / std::max(d, 1e-30);
      fluence += term.transport_mm > 0 ? term.fluence_mm * fall / term.transport_mm : -term.fluence_mm * d;
    }
    slab.transmitted[c] += first.fluence_mm != 0 ? 2 * std::numbers::pi * fluence : 0;
  }
  return slab;
}

SlabGain slab_gain(const Coefficients& material, double thickness_mm) {
  // In the mean of both faces and in half their difference; for each the slab's response over the integral's.
  const SlabResponse right = slab_response(material, thickness_mm);
  const SlabResponse said = integral_slab_response(material, thickness_mm);
  SlabGain gain;
  for (int c = 0; c < 3; ++c) {
    const double sum = (right.reflected[c] + right.transmitted[c]) / (said.reflected[c] + said.transmitted[c]);
    // Both go to 0 with the square of the thickness, below which the faces cannot differ.
    const double difference = said.reflected[c] - said.transmitted[c];
    const double contrast =
        difference > 1e-4 * said.reflected[c] ? (right.reflected[c] - right.transmitted[c]) / difference : sum;
    gain.own[c] = static_cast<float>(0.5 * (sum + contrast));
    gain.opposite[c] = static_cast<float>(0.5 * (sum - contrast));
  }
  return gain;
}

}  // namespace diaphane::optics

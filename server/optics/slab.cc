#include "optics/slab.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"

namespace diaphane::optics {
namespace {

double extinction_mm(const Coefficients& material, int channel) {
  return double{material.absorption_mm[channel]} + double{material.reduced_scattering_mm[channel]};
}

TransportSlab channel_of(const Coefficients& material, int channel) {
  return {material.reduced_scattering_mm[channel] / extinction_mm(material, channel), material.refractive_index};
}

}  // namespace

Slab::Slab(const Coefficients& material)
    : material_(material), channels_{channel_of(material, 0), channel_of(material, 1), channel_of(material, 2)} {}

SlabResponse Slab::response(double thickness_mm) const {
  SlabResponse slab;
  for (int c = 0; c < 3; ++c) {
    const glm::dvec2 shares = channels_[static_cast<size_t>(c)].at(thickness_mm * extinction_mm(material_, c));
    slab.reflected[c] = shares.x;
    slab.transmitted[c] = shares.y;
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

SlabGain Slab::gain(double thickness_mm) const {
  // In the mean of both faces and in half their difference; for each the slab's response over the integral's.
  const SlabResponse right = response(thickness_mm);
  const SlabResponse said = integral_slab_response(material_, thickness_mm);
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

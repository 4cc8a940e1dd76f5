// Radiative transfer in a slab: what scattering once and more gives back, at every thickness and albedo.
#pragma once

#include <vector>

#include "glm/vec2.hpp"

namespace diaphane::optics {

/// A slab that scatters isotropically between Fresnel boundaries, in unit mean free paths: by doubling of layers
/// (van de Hulst 1980, Prahl 1995) in 16 directions inside, Gaussian below and above the critical angle. Immutable.
class TransportSlab {
 public:
  /// `albedo` 0..1 of one scattering event, `refractive_index` 1..3.
  TransportSlab(double albedo, double refractive_index);

  /// Shares of the light that enters along the normal which leave after scattering: through the same face (x), and
  /// through the other (y). `thickness` ≥ 0; beyond 2000 mean free paths as there, but what crosses falls on as 1/d.
  glm::dvec2 at(double thickness) const;

 private:
  std::vector<glm::dvec2> logarithms_;  ///< of both, by ln thickness
};

}  // namespace diaphane::optics

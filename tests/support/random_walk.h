// Light in a slab by random walk: the judge of slabs.
#pragma once

namespace diaphane::testing {

/// Shares of the light that enters a slab along its normal.
struct WalkedSlab {
  double reflected, transmitted;  ///< after scattering at least once
  double unscattered;
};

/// `walks` photons in a slab of `thickness` mean free paths that scatters isotropically with the albedo `albedo`
/// between Fresnel boundaries of index `refractive_index` (inside over outside). The same every time.
WalkedSlab walk_slab(double albedo, double refractive_index, double thickness, int walks);

}  // namespace diaphane::testing

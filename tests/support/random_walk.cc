#include "tests/support/random_walk.h"

#include <cmath>
#include <random>

namespace diaphane::testing {
namespace {

/// Unpolarised reflectance from inside at the cosine `mu`.
double reflectance(double refractive_index, double mu) {
  const double sine2 = refractive_index * refractive_index * (1 - mu * mu);
  if (sine2 >= 1) return 1;
  const double outside = std::sqrt(1 - sine2);
  const double s = (refractive_index * mu - outside) / (refractive_index * mu + outside);
  const double p = (mu - refractive_index * outside) / (mu + refractive_index * outside);
  return 0.5 * (s * s + p * p);
}

}  // namespace

WalkedSlab walk_slab(double albedo, double refractive_index, double thickness, int walks) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  WalkedSlab slab{};
  for (int i = 0; i < walks; ++i) {
    double z = 0, mu = 1, weight = 1;
    bool scattered = false;
    while (true) {
      z -= mu * std::log(1 - share(random));
      if (z < 0 || z > thickness) {
        const bool far = z > thickness;
        z = far ? thickness : 0;
        if (share(random) < reflectance(refractive_index, std::abs(mu))) {
          mu = -mu;
          continue;
        }
        (!scattered ? slab.unscattered : far ? slab.transmitted : slab.reflected) += weight;
        break;
      }
      scattered = true;
      weight *= albedo;
      if (weight < 0.05) {
        if (share(random) < 0.5) break;
        weight *= 2;
      }
      mu = 2 * share(random) - 1;
    }
  }
  slab.reflected /= walks;
  slab.transmitted /= walks;
  slab.unscattered /= walks;
  return slab;
}

}  // namespace diaphane::testing

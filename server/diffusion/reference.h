// The surface integral by brute force: the judge of every faster way.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "diffusion/surfels.h"
#include "glm/vec3.hpp"
#include "optics/profile.h"

namespace diaphane::diffusion {

struct ReferenceOptions {
  int threads = 0;                               ///< 0: all cores
  std::function<void(double)> progress;          ///< told the share done, 0..1, ascending, by one thread at a time
  const std::atomic<bool>* cancelled = nullptr;  ///< checked every few milliseconds
};

/// A profile as sums over surfels can take it: B(x) = Σ Φ·spread(|x − y|) + local·E(x).
struct ReferenceKernel {
  optics::ReflectanceProfile spread;
  glm::vec3 local{0};
  float spacing_mm = 0;  ///< between surfels, at most
};

/// A dipole spreads whole. Normalized diffusion is infinite at r = 0: its r becomes √(r² + (l/4s)²), and what that
/// takes away, an eighth of the whole at most, is local.
ReferenceKernel reference_kernel(const optics::ReflectanceProfile& profile);

/// B(x) = Σ Φ·Rd(|x − y|) at every receiver, RGB, W·mm⁻²: every pair, in float within blocks, in double across them.
/// Surfels without flux are left out. Errors: CANCELLED once `cancelled` is seen set. Thread-safe.
absl::StatusOr<std::vector<glm::vec3>> reference_radiosity(const optics::ReflectanceProfile& profile,
                                                           const Surfels& surfels,
                                                           std::span<const glm::vec3> receivers_mm,
                                                           const ReferenceOptions& options = {});

}  // namespace diaphane::diffusion

// The dipole integral by brute force: the judge of every faster way.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "diffusion/surfels.h"
#include "glm/vec3.hpp"
#include "optics/dipole.h"

namespace diaphane::diffusion {

struct ReferenceOptions {
  int threads = 0;                               ///< 0: all cores
  std::function<void(double)> progress;          ///< told the share done, 0..1, ascending, by one thread at a time
  const std::atomic<bool>* cancelled = nullptr;  ///< checked every few milliseconds
};

/// B(x) = Σ Φ·Rd(|x − y|) at every receiver, RGB, W·mm⁻²: every pair, in float within blocks, in double across them.
/// Surfels without flux are left out. Errors: CANCELLED once `cancelled` is seen set. Thread-safe.
absl::StatusOr<std::vector<glm::vec3>> reference_radiosity(const optics::Dipole& dipole, const Surfels& surfels,
                                                           std::span<const glm::vec3> receivers_mm,
                                                           const ReferenceOptions& options = {});

}  // namespace diaphane::diffusion

// Which instructions the room's inner loops use.
#pragma once

#include <string>
#include <vector>

namespace diaphane::diffusion {

/// The level in use: "AVX3" (AVX-512), "AVX2", "SSE4", "NEON", "SCALAR". The best that the machine has, unless chosen.
/// Results are the same bytes for the same level. Thread-safe.
std::string simd_level();

/// Levels that this machine runs and this program holds, best first. Thread-safe.
std::vector<std::string> simd_levels();

/// Uses `level`, or the best again where it is empty; false, with nothing changed, where it is not one of
/// simd_levels(). For tests and benches: not while anything else in the room runs.
bool choose_simd_level(const std::string& level);

}  // namespace diaphane::diffusion

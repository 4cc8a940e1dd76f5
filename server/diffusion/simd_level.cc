#include "diffusion/simd_level.h"

#include <atomic>

#include "hwy/highway.h"

namespace diaphane::diffusion {
namespace {

std::vector<int64_t> usable_targets() { return hwy::SupportedAndGeneratedTargets(); }

/// Asked of every frame: the list of targets would be made anew each time.
std::atomic<const char*>& current_level() {
  static std::atomic<const char*> level = hwy::TargetName(usable_targets().front());
  return level;
}

}  // namespace

std::string simd_level() { return current_level().load(); }

std::vector<std::string> simd_levels() {
  std::vector<std::string> names;
  for (const int64_t target : usable_targets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

bool choose_simd_level(const std::string& level) {
  const std::string before = simd_level();
  hwy::SetSupportedTargetsForTest(0);
  int64_t chosen = 0;
  for (const int64_t target : usable_targets()) {
    if (level == hwy::TargetName(target)) chosen = target;
  }
  const bool known = level.empty() || chosen != 0;
  if (!known && simd_level() != before) return choose_simd_level(before), false;
  hwy::SetSupportedTargetsForTest(chosen);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  current_level() = hwy::TargetName(usable_targets().front());
  return known;
}

}  // namespace diaphane::diffusion

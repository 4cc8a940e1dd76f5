#include "diffusion/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "hwy/aligned_allocator.h"
#include "tbb/parallel_for.h"
#include "tbb/task_arena.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffusion/reference.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "hwy/contrib/math/math-inl.h"
// clang-format on

#ifndef DIAPHANE_DIFFUSION_REFERENCE_ONCE
#define DIAPHANE_DIFFUSION_REFERENCE_ONCE
namespace diaphane::diffusion {

/// Lit surfels as arrays, padded without flux to a multiple of kPad.
struct SourceArrays {
  static constexpr size_t kPad = 64;
  hwy::AlignedFreeUniquePtr<float[]> values;
  size_t count = 0;
  const float* row(size_t field) const { return values.get() + field * count; }
};

/// A term of one channel: what of it does not depend on r.
struct TermConstants {
  float transport_mm, height2, flux, fluence;
};
using ChannelConstants = std::array<TermConstants, 2>;

}  // namespace diaphane::diffusion
#endif

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// (flux (1 + σd)/d³ + fluence/d) e^(−σd) at d = √(r² + height²).
template <class D, class V>
HWY_INLINE V term_value(D d, V distance2, const TermConstants& k) {
  const V d2 = hn::Add(distance2, hn::Set(d, k.height2));
  const V range = hn::Sqrt(d2);
  const V depth = hn::Mul(hn::Set(d, k.transport_mm), range);
  const V flux = hn::Div(hn::Mul(hn::Set(d, k.flux), hn::Add(hn::Set(d, 1.0f), depth)), d2);
  return hn::Div(hn::Mul(hn::Add(flux, hn::Set(d, k.fluence)), hn::Exp(d, hn::Neg(depth))), range);
}

void sum_block(const ChannelConstants* channels, const SourceArrays& sources, size_t begin, size_t end,
               const float* receiver, float* sums) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V x = hn::Set(d, receiver[0]), y = hn::Set(d, receiver[1]), z = hn::Set(d, receiver[2]);
  V total[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const V dx = hn::Sub(x, hn::Load(d, sources.row(0) + i));
    const V dy = hn::Sub(y, hn::Load(d, sources.row(1) + i));
    const V dz = hn::Sub(z, hn::Load(d, sources.row(2) + i));
    const V distance2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    for (int c = 0; c < 3; ++c) {
      const V rd = hn::Add(term_value(d, distance2, channels[c][0]), term_value(d, distance2, channels[c][1]));
      total[c] = hn::MulAdd(rd, hn::Load(d, sources.row(3 + c) + i), total[c]);
    }
  }
  for (int c = 0; c < 3; ++c) sums[c] = hn::GetLane(hn::SumOfLanes(d, total[c]));
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::diffusion {
HWY_EXPORT(sum_block);
namespace {

/// Of l/s, what rounds off the pole of normalized diffusion.
constexpr double kSoftening = 0.25;

SourceArrays lit_sources(const Surfels& surfels) {
  SourceArrays sources;
  const auto lit = [](const glm::vec3& flux) { return flux.x != 0 || flux.y != 0 || flux.z != 0; };
  const auto count = static_cast<size_t>(std::count_if(surfels.flux_w.begin(), surfels.flux_w.end(), lit));
  sources.count = (count + SourceArrays::kPad - 1) / SourceArrays::kPad * SourceArrays::kPad;
  sources.values = hwy::AllocateAligned<float>(std::max<size_t>(6 * sources.count, 1));
  std::fill_n(sources.values.get(), 6 * sources.count, 0.0f);
  size_t slot = 0;
  for (size_t i = 0; i < surfels.flux_w.size(); ++i) {
    if (!lit(surfels.flux_w[i])) continue;
    for (int k = 0; k < 3; ++k) {
      sources.values[static_cast<size_t>(k) * sources.count + slot] = surfels.positions_mm[i][k];
      sources.values[static_cast<size_t>(3 + k) * sources.count + slot] = surfels.flux_w[i][k];
    }
    ++slot;
  }
  return sources;
}

}  // namespace

ReferenceKernel reference_kernel(const optics::ReflectanceProfile& profile) {
  ReferenceKernel kernel{profile, glm::vec3(0), std::numeric_limits<float>::infinity()};
  for (int c = 0; c < 3; ++c) {
    optics::ChannelProfile& channel = kernel.spread[c];
    if (channel.terms[0].height_mm > 0) {
      kernel.spacing_mm = std::min(kernel.spacing_mm, static_cast<float>(0.5 * channel.terms[0].height_mm));
      continue;
    }
    const double height = kSoftening / channel.terms[0].transport_mm;
    double spread = 0;
    for (optics::ProfileTerm& term : channel.terms) {
      term.height_mm = height;
      spread += 2 * std::numbers::pi * term.fluence_mm / term.transport_mm * std::exp(-term.transport_mm * height);
    }
    kernel.local[c] = static_cast<float>(channel.total - spread);
    kernel.spacing_mm = std::min(kernel.spacing_mm, static_cast<float>(height));
  }
  return kernel;
}

absl::StatusOr<std::vector<glm::vec3>> reference_radiosity(const optics::ReflectanceProfile& profile,
                                                           const Surfels& surfels,
                                                           std::span<const glm::vec3> receivers_mm,
                                                           const ReferenceOptions& options) {
  ChannelConstants channels[3];
  for (int c = 0; c < 3; ++c) {
    for (size_t k = 0; k < 2; ++k) {
      const optics::ProfileTerm& term = profile[c].terms[k];
      channels[c][k] = {static_cast<float>(term.transport_mm), static_cast<float>(term.height_mm * term.height_mm),
                        static_cast<float>(term.flux_mm), static_cast<float>(term.fluence_mm)};
    }
  }
  const SourceArrays sources = lit_sources(surfels);
  std::vector<glm::vec3> radiosity(receivers_mm.size());
  const auto is_cancelled = [&] { return options.cancelled && options.cancelled->load(std::memory_order_relaxed); };
  std::mutex progress_mutex;
  size_t receivers_done = 0;
  constexpr size_t kBlock = 4096;
  const auto sum_receiver = [&](size_t r) {
    glm::dvec3 total(0);
    for (size_t begin = 0; begin < sources.count; begin += kBlock) {
      if (is_cancelled()) return;
      float sums[3];
      HWY_DYNAMIC_DISPATCH(sum_block)
      (channels, sources, begin, std::min(begin + kBlock, sources.count), &receivers_mm[r].x, sums);
      total += glm::dvec3(sums[0], sums[1], sums[2]);
    }
    radiosity[r] = glm::vec3(total);
    if (options.progress) {
      const std::lock_guard lock(progress_mutex);
      options.progress(static_cast<double>(++receivers_done) / static_cast<double>(receivers_mm.size()));
    }
  };
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(size_t{0}, receivers_mm.size(), sum_receiver); });
  if (is_cancelled()) return absl::CancelledError("reference: cancelled");
  return radiosity;
}

}  // namespace diaphane::diffusion
#endif

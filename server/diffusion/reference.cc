#include "diffusion/reference.h"

#include <algorithm>
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

/// Constants of one channel: what of Rd does not depend on r.
struct ChannelConstants {
  float transport_mm;
  float real_height2, virtual_height2;
  float real_weight, virtual_weight;  ///< α'/4π times the height
};

}  // namespace diaphane::diffusion
#endif

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// weight (1 + σd) e^(−σd)/d³ at d = √(r² + height²).
template <class D, class V>
HWY_INLINE V source_term(D d, V distance2, float height2, float weight, float transport) {
  const V d2 = hn::Add(distance2, hn::Set(d, height2));
  const V range = hn::Sqrt(d2);
  const V depth = hn::Mul(hn::Set(d, transport), range);
  const V numerator =
      hn::Mul(hn::Mul(hn::Set(d, weight), hn::Add(hn::Set(d, 1.0f), depth)), hn::Exp(d, hn::Neg(depth)));
  return hn::Div(numerator, hn::Mul(d2, range));
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
      const ChannelConstants& k = channels[c];
      const V rd = hn::Add(source_term(d, distance2, k.real_height2, k.real_weight, k.transport_mm),
                           source_term(d, distance2, k.virtual_height2, k.virtual_weight, k.transport_mm));
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

absl::StatusOr<std::vector<glm::vec3>> reference_radiosity(const optics::Dipole& dipole, const Surfels& surfels,
                                                           std::span<const glm::vec3> receivers_mm,
                                                           const ReferenceOptions& options) {
  ChannelConstants channels[3];
  for (int c = 0; c < 3; ++c) {
    const float scale = dipole.reduced_albedo[c] / (4 * std::numbers::pi_v<float>);
    const float real = dipole.mean_free_path_mm[c], image = dipole.virtual_height_mm[c];
    channels[c] = {dipole.effective_transport_mm[c], real * real, image * image, scale * real, scale * image};
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

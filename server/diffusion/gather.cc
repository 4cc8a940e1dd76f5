#include "diffusion/gather.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffusion/gather.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "diffusion/far_field-inl.h"
#include "diffusion/kernel-inl.h"
#include "diffusion/leaf-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {

/// `from` about another centre.
void shift(const Expansion& from, const glm::vec3& centre_mm, Expansion& to) {
  to.centre_mm = centre_mm;
  const glm::vec3 h = centre_mm - from.centre_mm;
  for (int c = 0; c < 3; ++c) {
    const float* m = from.hessian[c];
    const float* g = from.gradient[c];
    const float turn[3] = {m[0] * h.x + m[3] * h.y + m[4] * h.z, m[3] * h.x + m[1] * h.y + m[5] * h.z,
                           m[4] * h.x + m[5] * h.y + m[2] * h.z};
    to.value[c] =
        from.value[c] + h.x * (g[0] + 0.5f * turn[0]) + h.y * (g[1] + 0.5f * turn[1]) + h.z * (g[2] + 0.5f * turn[2]);
    for (int a = 0; a < 3; ++a) to.gradient[c][a] = g[a] + turn[a];
    for (int i = 0; i < 6; ++i) to.hessian[c][i] = m[i];
  }
}

template <bool kColoured>
void descend(const GatherInput& input, GatherScratch& scratch, uint32_t level, uint32_t node,
             const Expansion& expansion, const uint32_t* near, size_t near_count, JobList* list) {
  const uint32_t child_level = level - 1;
  const NodeTree& tree = *input.tree;
  GatherScratch::Level& buffers = scratch.levels[child_level];
  const Pack pack = pack_children(tree, child_level, near, near_count, kColoured, buffers);
  if (child_level == NodeTree::kLeafLevel) {
    for (LeafSources& side : scratch.sides) {
      if (side.wide_moments.size() < buffers.near.size()) side.wide_moments.resize(buffers.near.size());
    }
  }
  const float* block = tree.block(child_level, node);
  for (uint32_t k = 0; k < 4 && 4 * node + k < tree.node_count(child_level); ++k) {
    const Receiver receiver{{block[4 * kCentreX + k], block[4 * kCentreY + k], block[4 * kCentreZ + k]},
                            block[4 * kSpread2 + k],
                            block[4 * kRadius + k],
                            block[4 * kArea + k],
                            {block[4 * kFacingX + k], block[4 * kFacingY + k], block[4 * kFacingZ + k]},
                            child_level == NodeTree::kLeafLevel ? std::sqrt(tree.spacing2_mm2[4 * node + k]) : 0.0f};
    Expansion own;
    shift(expansion, receiver.centre_mm, own);
    if (child_level == NodeTree::kLeafLevel) {
      const size_t open = far_field<kColoured, true>(input, pack, receiver, scratch, buffers, own);
      gather_leaf<kColoured>(input, 4 * node + k, receiver, own, pack, buffers.near.data(), open, scratch);
      continue;
    }
    const size_t open = far_field<kColoured, false>(input, pack, receiver, scratch, buffers, own);
    if (list && child_level == list->level) {
      if (list->jobs->size() == list->count) list->jobs->emplace_back();
      GatherJob& job = (*list->jobs)[list->count++];
      job.node = 4 * node + k;
      job.expansion = own;
      job.near.assign(buffers.near.data(), buffers.near.data() + open);
    } else {
      descend<kColoured>(input, scratch, child_level, 4 * node + k, own, buffers.near.data(), open, list);
    }
  }
}

void descend_from(const GatherInput& input, GatherScratch& scratch, uint32_t level, uint32_t node,
                  const Expansion& expansion, const uint32_t* near, size_t near_count, JobList* list) {
  const auto go = input.settings.coloured ? descend<true> : descend<false>;
  go(input, scratch, level, node, expansion, near, near_count, list);
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::diffusion {
HWY_EXPORT(descend_from);

uint32_t job_level(const NodeTree& tree) {
  constexpr uint32_t kEnoughJobs = 64;
  uint32_t level = tree.top_level();
  while (level > NodeTree::kLeafLevel + 1 && tree.node_count(level) < kEnoughJobs) --level;
  return level;
}

size_t collect_jobs(const GatherInput& input, GatherScratch& scratch, std::vector<GatherJob>& jobs) {
  const uint32_t top = input.tree->top_level();
  scratch.levels.resize(top + 1);
  JobList list{job_level(*input.tree), &jobs, 0};
  // The top node is the only child of a node above it that holds the same.
  constexpr uint32_t kAbove = 0;
  HWY_DYNAMIC_DISPATCH(descend_from)(input, scratch, top + 1, kAbove, Expansion{}, &kAbove, 1, &list);
  return list.count;
}

void run_job(const GatherInput& input, GatherScratch& scratch, const GatherJob& job) {
  scratch.levels.resize(input.tree->top_level() + 1);
  HWY_DYNAMIC_DISPATCH(descend_from)
  (input, scratch, job_level(*input.tree), job.node, job.expansion, job.near.data(), job.near.size(), nullptr);
}

}  // namespace diaphane::diffusion
#endif

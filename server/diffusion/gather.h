// Radiosity at every vertex from the tree: receivers and sources descend together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "diffusion/kernel_table.h"
#include "diffusion/node_tree.h"
#include "glm/vec3.hpp"
#include "tbb/cache_aligned_allocator.h"

namespace diaphane::diffusion {

/// When a pair of nodes is far enough apart for its moments to stand for it.
struct GatherSettings {
  float opening = 0.28f;       ///< θ between two nodes of a level
  float leaf_opening = 0.45f;  ///< θp between a node and the vertices of a leaf
  bool coloured = false;       ///< the flux's colour varies over the surface
};

/// Radiosity around a node's centre: value, gradient and Hessian (xx yy zz xy xz yz) of each channel.
struct Expansion {
  glm::vec3 centre_mm;
  float value[3];
  float gradient[3][3];
  float hessian[3][6];
};

/// A receiver node whose turn has yet to come.
struct GatherJob {
  uint32_t node = 0;
  Expansion expansion{};
  std::vector<uint32_t> near;  ///< sources of the node's own level that its children must look into
};

template <class T>
using AlignedVector = std::vector<T, tbb::cache_aligned_allocator<T>>;

/// Where descending stops to leave jobs behind.
struct JobList {
  uint32_t level;
  std::vector<GatherJob>* jobs;  ///< reused, grown
  size_t count;
};

/// The surface around a leaf, and what faces it from the other side of a thin part.
enum Side { kSame, kOpposite };

/// What a leaf adds up one by one.
struct LeafSources {
  AlignedVector<uint32_t> wide_moments;  ///< columns of the pack: whole leaves
  std::vector<const float*> moments;     ///< columns of level-1 blocks: four vertices
  std::vector<uint32_t> fours;           ///< first of four slots, each taken by itself
  size_t wide_moment_count = 0, moment_count = 0, four_count = 0;
};

/// Working memory of one thread; grows to what a body needs and stays.
struct GatherScratch {
  struct Level {
    AlignedVector<float> pack;  ///< rows of NodeField over the children of the near nodes
    AlignedVector<uint32_t> pack_nodes;
    AlignedVector<uint32_t> near;
  };
  std::vector<Level> levels;
  std::array<LeafSources, 2> sides;  ///< by Side
  KernelTable blended;
};

/// Everything that a gather reads, and where it writes.
struct GatherInput {
  const NodeTree* tree;
  const KernelSet* kernels;
  const glm::vec3* irradiance;     ///< [slot_count] for the local term
  const uint32_t* vertex_of_slot;  ///< [slot_count]
  glm::vec3* radiosity;            ///< by vertex; those that vertex_of_slot names are written
  GatherSettings settings;
};

/// The level whose nodes are jobs: enough of them to share out.
uint32_t job_level(const NodeTree& tree);

/// Descends to the jobs; gives how many of `jobs` (reused, grown) are in use.
size_t collect_jobs(const GatherInput& input, GatherScratch& scratch, std::vector<GatherJob>& jobs);
/// Finishes one job. Jobs are independent; each thread brings its own scratch.
void run_job(const GatherInput& input, GatherScratch& scratch, const GatherJob& job);

}  // namespace diaphane::diffusion

#include "diffusion/node_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "diffusion/four.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffusion/node_tree.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

// The vectors are four wide everywhere; the SIMD level says with which instructions.
HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {

constexpr uint32_t kChunkLevel = 4;
// Gives nodes without area or flux a centroid.
constexpr float kTinyWeight = 1e-25f;

/// The k-th children of four siblings, for each k, as vectors across the siblings.
struct Children {
  Four x[4], y[4], z[4];
};

/// Reads row `field` of the four blocks below block `index`, turned so that lanes are parents. Blocks past the end
/// repeat the first.
void load_children(const NodeTree& tree, uint32_t level, uint32_t index, uint32_t field, Four (&by_child)[4]) {
  const uint32_t blocks = tree.block_count(level - 1);
  for (uint32_t j = 0; j < 4; ++j) {
    const uint32_t child_block = 4 * index + j < blocks ? 4 * index + j : 4 * index;
    by_child[j] = load4(tree.block(level - 1, child_block) + 4 * field);
  }
  transpose4(by_child[0], by_child[1], by_child[2], by_child[3]);
}

/// 1 where the parent's children exist, else 0.
Four parent_exists(const NodeTree& tree, uint32_t level, uint32_t index) {
  const uint32_t blocks = tree.block_count(level - 1);
  Four exists{};
  for (uint32_t j = 0; j < 4; ++j) exists[j] = 4 * index + j < blocks ? 1.0f : 0.0f;
  return exists;
}

/// Slots 16·leaf + 4·j + k, as vectors across j, from structures that begin with four floats of interest at `offset`.
template <class T>
void load_slots(const T* slots, uint32_t offset, uint32_t k, Four (&fields)[4]) {
  for (uint32_t j = 0; j < 4; ++j) fields[j] = load4(reinterpret_cast<const float*>(slots + 4 * j + k) + offset);
  transpose4(fields[0], fields[1], fields[2], fields[3]);
}

struct GeometryChildren : Children {
  Four area[4], spread2[4], radius[4];
  Four facing[3][4];
};

/// `kPoints`: the children have no extent of their own.
template <bool kPoints>
void refit_geometry_block(const GeometryChildren& c, float* block) {
  Four weight[4];
  Four area{}, total{}, x{}, y{}, z{};
  for (int k = 0; k < 4; ++k) {
    weight[k] = c.area[k] + kTinyWeight;
    area += c.area[k];
    total += weight[k];
    x += weight[k] * c.x[k];
    y += weight[k] * c.y[k];
    z += weight[k] * c.z[k];
  }
  const Four inverse = 1.0f / total;
  x *= inverse, y *= inverse, z *= inverse;
  Four spread2{}, radius{};
  for (int k = 0; k < 4; ++k) {
    const Four dx = c.x[k] - x, dy = c.y[k] - y, dz = c.z[k] - z;
    const Four distance2 = dx * dx + dy * dy + dz * dz;
    if constexpr (kPoints) {
      spread2 += weight[k] * distance2;
      radius = max4(radius, distance2);
    } else {
      spread2 += weight[k] * (c.spread2[k] + distance2);
      radius = max4(radius, c.radius[k] + sqrt4(distance2));
    }
  }
  store4(block + 4 * kCentreX, x);
  store4(block + 4 * kCentreY, y);
  store4(block + 4 * kCentreZ, z);
  store4(block + 4 * kArea, area);
  store4(block + 4 * kSpread2, spread2 * inverse);
  store4(block + 4 * kRadius, kPoints ? sqrt4(radius) : radius);
  for (uint32_t a = 0; a < 3; ++a) {
    store4(block + 4 * (kFacingX + a), c.facing[a][0] + c.facing[a][1] + c.facing[a][2] + c.facing[a][3]);
  }
}

void refit_geometry_level1(NodeTree& tree, uint32_t leaf) {
  GeometryChildren c;
  for (uint32_t k = 0; k < 4; ++k) {
    Four low[4], high[4];
    load_slots(&tree.places[size_t{16} * leaf], 0, k, low);
    load_slots(&tree.places[size_t{16} * leaf], 4, k, high);
    c.x[k] = low[0], c.y[k] = low[1], c.z[k] = low[2], c.area[k] = low[3];
    for (int a = 0; a < 3; ++a) c.facing[a][k] = high[a];
  }
  refit_geometry_block<true>(c, tree.block(1, leaf));
}

void refit_geometry_above(NodeTree& tree, uint32_t level, uint32_t index) {
  GeometryChildren c;
  load_children(tree, level, index, kCentreX, c.x);
  load_children(tree, level, index, kCentreY, c.y);
  load_children(tree, level, index, kCentreZ, c.z);
  load_children(tree, level, index, kArea, c.area);
  load_children(tree, level, index, kSpread2, c.spread2);
  load_children(tree, level, index, kRadius, c.radius);
  const Four exists = parent_exists(tree, level, index);
  for (Four& area : c.area) area *= exists;
  for (uint32_t a = 0; a < 3; ++a) {
    load_children(tree, level, index, kFacingX + a, c.facing[a]);
    for (Four& facing : c.facing[a]) facing *= exists;
  }
  refit_geometry_block<false>(c, tree.block(level, index));
}

float largest_of(Four v) { return std::max(std::max(v[0], v[1]), std::max(v[2], v[3])); }

/// The radius of a leaf from its vertices (a bound through the children's spheres is a third larger), and its spacing.
void measure_leaf(NodeTree& tree, uint32_t leaf) {
  float* block = tree.block(NodeTree::kLeafLevel, leaf / 4) + leaf % 4;
  const glm::vec3 centre(block[4 * kCentreX], block[4 * kCentreY], block[4 * kCentreZ]);
  Four radius2{}, largest{}, sum{};
  for (uint32_t k = 0; k < 4; ++k) {
    Four fields[4];
    load_slots(&tree.places[size_t{16} * leaf], 0, k, fields);
    const Four x = fields[0] - centre.x, y = fields[1] - centre.y, z = fields[2] - centre.z;
    radius2 = max4(radius2, x * x + y * y + z * z);
    largest = max4(largest, fields[3]);
    sum += fields[3];
  }
  block[4 * kRadius] = std::sqrt(largest_of(radius2));
  const uint32_t real = std::min(16u, tree.slot_count() - 16 * leaf);
  const float area = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  tree.spacing2_mm2[leaf] = 0.5f * (area / static_cast<float>(real) + largest_of(largest));
}

struct FluxChildren : Children {
  Four flux[3][4];
  Four covariance[6][4];
  Four dipole[9][4];
};

/// `kPoints`: the children have no moments of their own.
template <bool kPoints>
void refit_flux_block(const FluxChildren& c, bool coloured, float* block) {
  Four weight[4];
  Four total{}, x{}, y{}, z{};
  for (int k = 0; k < 4; ++k) {
    weight[k] = c.flux[0][k] + c.flux[1][k] + c.flux[2][k] + kTinyWeight;
    total += weight[k];
    x += weight[k] * c.x[k];
    y += weight[k] * c.y[k];
    z += weight[k] * c.z[k];
  }
  const Four inverse = 1.0f / total;
  x *= inverse, y *= inverse, z *= inverse;
  store4(block + 4 * kFluxX, x);
  store4(block + 4 * kFluxY, y);
  store4(block + 4 * kFluxZ, z);
  Four covariance[6] = {}, dipole[9] = {};
  for (int k = 0; k < 4; ++k) {
    const Four dx = c.x[k] - x, dy = c.y[k] - y, dz = c.z[k] - z;
    const Four moments[6] = {dx * dx, dy * dy, dz * dz, 2.0f * dx * dy, 2.0f * dx * dz, 2.0f * dy * dz};
    for (int m = 0; m < 6; ++m) {
      covariance[m] += weight[k] * (kPoints ? moments[m] : c.covariance[m][k] + moments[m]);
    }
    if (!coloured) continue;
    const Four way[3] = {dx, dy, dz};
    for (int m = 0; m < 9; ++m) {
      if constexpr (!kPoints) dipole[m] += c.dipole[m][k];
      dipole[m] += c.flux[m / 3][k] * way[m % 3];
    }
  }
  for (uint32_t channel = 0; channel < 3; ++channel) {
    store4(block + 4 * (kFluxR + channel),
           c.flux[channel][0] + c.flux[channel][1] + c.flux[channel][2] + c.flux[channel][3]);
  }
  for (uint32_t m = 0; m < 6; ++m) store4(block + 4 * (kCovXX + m), covariance[m] * inverse);
  if (!coloured) return;
  for (uint32_t m = 0; m < 9; ++m) store4(block + 4 * (kDipole + m), dipole[m]);
}

void refit_flux_level1(NodeTree& tree, uint32_t leaf, bool coloured) {
  FluxChildren c;
  for (uint32_t k = 0; k < 4; ++k) {
    Four low[4], high[4];
    load_slots(&tree.sources[size_t{16} * leaf], 0, k, low);
    load_slots(&tree.sources[size_t{16} * leaf], 4, k, high);
    c.x[k] = low[0], c.y[k] = low[1], c.z[k] = low[2];
    c.flux[0][k] = low[3], c.flux[1][k] = high[0], c.flux[2][k] = high[1];
  }
  refit_flux_block<true>(c, coloured, tree.block(1, leaf));
}

void refit_flux_above(NodeTree& tree, uint32_t level, uint32_t index, bool coloured) {
  FluxChildren c;
  load_children(tree, level, index, kFluxX, c.x);
  load_children(tree, level, index, kFluxY, c.y);
  load_children(tree, level, index, kFluxZ, c.z);
  const Four exists = parent_exists(tree, level, index);
  for (uint32_t channel = 0; channel < 3; ++channel) {
    load_children(tree, level, index, kFluxR + channel, c.flux[channel]);
    for (Four& flux : c.flux[channel]) flux *= exists;
  }
  for (uint32_t m = 0; m < 6; ++m) load_children(tree, level, index, kCovXX + m, c.covariance[m]);
  if (coloured) {
    for (uint32_t m = 0; m < 9; ++m) {
      load_children(tree, level, index, kDipole + m, c.dipole[m]);
      for (Four& moment : c.dipole[m]) moment *= exists;
    }
  }
  refit_flux_block<false>(c, coloured, tree.block(level, index));
}

/// Calls visit(level, block) for the blocks above level 1 whose slots are in `chunk`, from below.
template <class Visit>
void for_blocks_of_chunk(const NodeTree& tree, uint32_t chunk, const Visit& visit) {
  for (uint32_t level = 2; level < kChunkLevel && level <= tree.top_level(); ++level) {
    const uint32_t per_chunk = 1u << (2 * (kChunkLevel - 1 - level));
    const uint32_t end = std::min((chunk + 1) * per_chunk, tree.block_count(level));
    for (uint32_t index = chunk * per_chunk; index < end; ++index) visit(level, index);
  }
}

template <class Visit>
void for_blocks_of_top(const NodeTree& tree, const Visit& visit) {
  for (uint32_t level = kChunkLevel; level <= tree.top_level(); ++level) {
    for (uint32_t index = 0; index < tree.block_count(level); ++index) visit(level, index);
  }
}

uint32_t first_leaf(uint32_t chunk) { return chunk * (NodeTree::kChunkSlots / 16); }
uint32_t end_leaf(const NodeTree& tree, uint32_t chunk) { return std::min(first_leaf(chunk + 1), tree.leaf_count()); }

void refit_geometry(NodeTree& tree, uint32_t chunk) {
  for (uint32_t leaf = first_leaf(chunk); leaf < end_leaf(tree, chunk); ++leaf) refit_geometry_level1(tree, leaf);
  for_blocks_of_chunk(tree, chunk, [&](uint32_t level, uint32_t index) HWY_ATTR {
    refit_geometry_above(tree, level, index);
    if (level != NodeTree::kLeafLevel) return;
    for (uint32_t leaf = 4 * index; leaf < std::min(4 * index + 4, tree.leaf_count()); ++leaf) measure_leaf(tree, leaf);
  });
}

void refit_geometry_of_top(NodeTree& tree) {
  for_blocks_of_top(tree, [&](uint32_t level, uint32_t index) HWY_ATTR { refit_geometry_above(tree, level, index); });
}

void refit_flux(NodeTree& tree, uint32_t chunk, bool coloured) {
  for (uint32_t leaf = first_leaf(chunk); leaf < end_leaf(tree, chunk); ++leaf) refit_flux_level1(tree, leaf, coloured);
  for_blocks_of_chunk(tree, chunk,
                      [&](uint32_t level, uint32_t index) HWY_ATTR { refit_flux_above(tree, level, index, coloured); });
}

void refit_flux_of_top(NodeTree& tree, bool coloured) {
  for_blocks_of_top(tree,
                    [&](uint32_t level, uint32_t index) HWY_ATTR { refit_flux_above(tree, level, index, coloured); });
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::diffusion {
HWY_EXPORT(refit_geometry);
HWY_EXPORT(refit_geometry_of_top);
HWY_EXPORT(refit_flux);
HWY_EXPORT(refit_flux_of_top);

namespace {

constexpr int kStepBias = (127 - 32) << 2;

}  // namespace

SpacingPosition locate_spacing(float spacing2_mm2) {
  // The exponent and the mantissa's top two bits; the bits below are the way to the next step.
  const float lowest = spacing_of_step(0) * spacing_of_step(0);
  const auto bits = std::bit_cast<uint32_t>(std::max(spacing2_mm2, lowest));
  const int step = static_cast<int>(bits >> 21) - kStepBias;
  if (step >= static_cast<int>(kSpacingSteps) - 1) return {kSpacingSteps - 2, 1};
  return {static_cast<uint8_t>(std::max(step, 0)), static_cast<float>(bits & 0x1fffff) / 0x200000};
}

float spacing_of_step(uint32_t step) {
  return std::sqrt(std::bit_cast<float>((step + static_cast<uint32_t>(kStepBias)) << 21));
}

NodeTree::NodeTree(uint32_t slot_count) : slot_count_(slot_count) {
  uint32_t top = kLeafLevel;
  while (node_count(top) > 1) ++top;
  blocks_.resize(top + 1);
  for (uint32_t level = 1; level <= top; ++level)
    blocks_[level].assign(size_t{block_count(level)} * kBlockFloats, 0.0f);
  places.resize(size_t{16} * leaf_count());
  sources.resize(size_t{16} * leaf_count());
  spacing2_mm2.resize(leaf_count());
}

void NodeTree::refit_geometry_chunk(uint32_t chunk) { HWY_DYNAMIC_DISPATCH(refit_geometry)(*this, chunk); }

void NodeTree::refit_geometry_top() { HWY_DYNAMIC_DISPATCH(refit_geometry_of_top)(*this); }

void NodeTree::refit_flux_chunk(uint32_t chunk, bool coloured) {
  HWY_DYNAMIC_DISPATCH(refit_flux)(*this, chunk, coloured);
}

void NodeTree::refit_flux_top(bool coloured) { HWY_DYNAMIC_DISPATCH(refit_flux_of_top)(*this, coloured); }

size_t NodeTree::bytes() const {
  size_t sum = places.size() * sizeof(Place) + sources.size() * sizeof(Source) + spacing2_mm2.size() * sizeof(float);
  for (const std::vector<float>& level : blocks_) sum += level.size() * sizeof(float);
  return sum;
}

}  // namespace diaphane::diffusion
#endif

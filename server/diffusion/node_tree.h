// The tree of the surface integral: storage of its nodes, and how they follow the surface and the light.
#pragma once

#include <cstdint>
#include <vector>

#include "glm/vec3.hpp"

namespace diaphane::diffusion {

/// What a node above the vertices holds. "Centre" is weighted by area and serves tests and receivers; "flux" is about
/// the centroid weighted by R + G + B and serves sources.
enum NodeField : uint32_t {
  kCentreX,
  kCentreY,
  kCentreZ,  ///< mm
  kArea,     ///< mm²
  kSpread2,  ///< area-weighted mean square distance from the centre, mm²
  kRadius,   ///< no vertex is farther from the centre, mm
  kFacingX,
  kFacingY,
  kFacingZ,  ///< Σ area vectors, mm²: as long as kArea where all face one way
  kFluxX,
  kFluxY,
  kFluxZ,  ///< flux centroid, mm
  kFluxR,
  kFluxG,
  kFluxB,  ///< W
  kCovXX,
  kCovYY,
  kCovZZ,  ///< covariance of the flux about its centroid, mm²
  kCov2XY,
  kCov2XZ,
  kCov2YZ,  ///< twice its mixed terms
  kDipole,  ///< nine: Σ φ (y − centroid) of each channel, W·mm, three axes each
  kNodeFields = kDipole + 9
};

/// A vertex as a receiver.
struct Place {
  glm::vec3 position_mm{0};
  float area_mm2 = 0;            ///< a third of its triangles' areas
  glm::vec3 area_vector_mm2{0};  ///< a third of their area vectors, outward
  float unused = 0;
};

/// A vertex as a source: half way between the vertex and the mean of its triangles' centroids.
struct Source {
  glm::vec3 position_mm{0};
  glm::vec3 flux_w{0};
  float unused[2] = {0, 0};  ///< fills a power of two
};

/// An implicit 4-ary tree: node i of level L stands for slots [i·4^L, (i + 1)·4^L). Level 2, sixteen slots, is a leaf.
/// Four siblings share a block: field f of sibling k is block[4·f + k]. Node i's children are block i one level below.
class NodeTree {
 public:
  static constexpr uint32_t kLeafLevel = 2;
  static constexpr uint32_t kLeafSlots = 16;
  static constexpr uint32_t kBlockFloats = 4 * kNodeFields;

  explicit NodeTree(uint32_t slot_count);

  uint32_t slot_count() const { return slot_count_; }
  /// Nodes that stand for at least one slot.
  uint32_t node_count(uint32_t level) const {
    return static_cast<uint32_t>(((uint64_t{slot_count_} - 1) >> (2 * level)) + 1);
  }
  uint32_t leaf_count() const { return node_count(kLeafLevel); }
  uint32_t block_count(uint32_t level) const { return node_count(level + 1); }
  /// The level of the one node that holds everything; at least kLeafLevel.
  uint32_t top_level() const { return static_cast<uint32_t>(blocks_.size()) - 1; }

  float* block(uint32_t level, uint32_t index) { return &blocks_[level][size_t{index} * kBlockFloats]; }
  const float* block(uint32_t level, uint32_t index) const { return &blocks_[level][size_t{index} * kBlockFloats]; }

  /// [16·leaf_count]; those past slot_count repeat the last slot, without area or flux.
  std::vector<Place> places;
  std::vector<Source> sources;
  /// [leaf_count] ½(mean + max area) of the leaf's vertices: s².
  std::vector<float> spacing2_mm2;

  /// Work is dealt out in chunks of this many slots; chunks know nothing of each other.
  static constexpr uint32_t kChunkSlots = 256;
  uint32_t chunk_count() const { return node_count(4); }

  /// Centre, area, spread, radius and spacing, from `places`: first every chunk, then the top, once.
  void refit_geometry_chunk(uint32_t chunk);
  void refit_geometry_top();
  /// Flux, its centroid and moments, from `sources`: likewise. Dipoles are left alone unless `coloured`.
  void refit_flux_chunk(uint32_t chunk, bool coloured);
  void refit_flux_top(bool coloured);

  size_t bytes() const;

 private:
  uint32_t slot_count_;
  std::vector<std::vector<float>> blocks_;  ///< by level; level 0 has none
};

/// Kernel tables stand at quarter octaves of s², s = √(½(mean + max area)) of a leaf's vertices; a leaf blends the two
/// around its own, so that nothing jumps as a body deforms.
constexpr uint32_t kSpacingSteps = 256;
struct SpacingPosition {
  uint8_t step = 0;  ///< below kSpacingSteps − 1
  float share = 0;   ///< of the next step's table, 0..1
};
SpacingPosition locate_spacing(float spacing2_mm2);
/// s at a step, mm.
float spacing_of_step(uint32_t step);

}  // namespace diaphane::diffusion

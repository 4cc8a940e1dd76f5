// What the triangles around a vertex give to it: area, direction, place as a source, flux.
#pragma once

#include <span>
#include <vector>

#include "diffusion/four.h"
#include "diffusion/node_tree.h"
#include "diffusion/surface_topology.h"
#include "glm/vec3.hpp"

namespace diaphane::diffusion {

/// Whether fluxes ≥ 0 (fourth lanes 0) have one colour, to rounding.
class Colour {
 public:
  void add(Four flux) {
    const Four sum =
        flux + __builtin_shufflevector(flux, flux, 1, 2, 0, 3) + __builtin_shufflevector(flux, flux, 2, 0, 1, 3);
    if (share_[3] == 0) {
      if (sum[0] > 0) share_ = flux / sum[0] + Four{0, 0, 0, 1};
      return;
    }
    const Four expected = share_ * sum, slack = kRounding * sum;
    mixed_ |= bits_of((flux > expected + slack) | (flux < expected - slack)) != 0;
  }
  void add(const Colour& other) {
    mixed_ |= other.mixed_;
    add(other.share_ * Four{1, 1, 1, 0});
  }
  bool mixed() const { return mixed_; }

 private:
  static constexpr float kRounding = 3e-5f;
  Four share_{};  ///< of each channel in the first flux that is not black; then the fourth lane is 1
  bool mixed_ = false;
};

/// The slots of a chunk and the triangles that touch them.
struct ChunkOfTriangles {
  uint32_t first_slot, end_slot;
  const uint32_t* halo;  ///< [halo_count] those whose smallest slot is in a chunk before
  size_t halo_count;
  size_t first_own, own_count;  ///< the others: a run of the surface's
  const uint32_t* corners;      ///< by corner of the surface, within the chunk: halo, then own
};

/// Sums over the triangles at each slot, a chunk of NodeTree::kChunkSlots at a time: what the chunk's triangles give is
/// computed where it is summed up, in memory of one thread that stays in its cache. Triangles across a chunk's border
/// are computed on both sides.
class VertexSums {
 public:
  /// Working memory of one thread; grows to the largest chunk and stays.
  using Scratch = std::vector<Four>;

  explicit VertexSums(const SurfaceTopology& surface);

  /// Places and areas of the chunk's slots, and of the padding behind the last; unit normals (+z without area) of their
  /// first vertices where `normals` is not empty; areas of the triangles whose smallest slot is in the chunk. Chunks
  /// are independent of each other.
  void sum_positions(uint32_t chunk, std::span<const glm::vec3> positions_mm, std::span<glm::vec3> normals,
                     NodeTree& tree, Scratch& scratch);

  /// Flux of the chunk's slots, once every chunk has its positions; gives its colour. Likewise.
  Colour sum_flux(uint32_t chunk, std::span<const glm::vec3> irradiance_at_triangles, NodeTree& tree,
                  Scratch& scratch) const;

  float triangle_area_mm2(uint32_t triangle) const { return areas_mm2_[triangle]; }
  size_t bytes() const;

 private:
  /// Grows `scratch` to two vectors a triangle, and whole fours of triangles.
  ChunkOfTriangles chunk_of(uint32_t chunk, Scratch& scratch) const;

  const SurfaceTopology& surface_;
  std::vector<uint32_t> first_own_;   ///< [chunks + 1] of the triangles whose smallest slot is in a chunk
  std::vector<uint32_t> first_halo_;  ///< [chunks + 1] into halo_
  std::vector<uint32_t> halo_;        ///< a chunk's other triangles
  std::vector<uint32_t> corners_;     ///< as surface.triangle_of_corner, counted within the chunk: halo, then own
  std::vector<float> areas_mm2_;      ///< of triangles
};

}  // namespace diaphane::diffusion

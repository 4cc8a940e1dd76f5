#include "diffusion/vertex_sums.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffusion/vertex_sums.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

// The vectors are four wide everywhere; the SIMD level says with which instructions.
HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {

/// Four points side by side.
struct Points {
  Four x, y, z;
};

/// Two vectors for each of `count` triangles: area vector and area; centroid times area.
template <class TriangleAt>
HWY_INLINE void measure_faces(size_t count, const TriangleAt& triangle_at, const glm::vec3* positions_mm, Four* faces) {
  for (size_t first = 0; first < count; first += 4) {
    // Lanes behind the last triangle repeat it.
    const glm::uvec3* const triangles[4] = {&triangle_at(first), &triangle_at(std::min(first + 1, count - 1)),
                                            &triangle_at(std::min(first + 2, count - 1)),
                                            &triangle_at(std::min(first + 3, count - 1))};
    Points corner[3];
    for (int c = 0; c < 3; ++c) {
      const auto load = [&](int lane) HWY_ATTR { return load3(&positions_mm[(*triangles[lane])[c]].x); };
      Four rows[4] = {load(0), load(1), load(2), load(3)};
      transpose4(rows[0], rows[1], rows[2], rows[3]);
      corner[c] = {rows[0], rows[1], rows[2]};
    }
    const auto& [a, b, c] = corner;
    const Points u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
    Four low[4] = {0.5f * (u.y * v.z - u.z * v.y), 0.5f * (u.z * v.x - u.x * v.z), 0.5f * (u.x * v.y - u.y * v.x)};
    low[3] = sqrt4(low[0] * low[0] + low[1] * low[1] + low[2] * low[2]);
    const Four third = low[3] * (1.0f / 3);
    Four high[4] = {third * (a.x + b.x + c.x), third * (a.y + b.y + c.y), third * (a.z + b.z + c.z), Four{}};
    transpose4(low[0], low[1], low[2], low[3]);
    transpose4(high[0], high[1], high[2], high[3]);
    // Room for whole fours behind the last.
    for (size_t lane = 0; lane < 4; ++lane) {
      faces[2 * (first + lane)] = low[lane];
      faces[2 * (first + lane) + 1] = high[lane];
    }
  }
}

void sum_positions(const ChunkOfTriangles& chunk, const SurfaceTopology& surface, const glm::vec3* positions_mm,
                   glm::vec3* normals, float* areas_mm2, NodeTree& tree, Four* faces) {
  const auto halo = [&](size_t i) -> const glm::uvec3& { return surface.triangles[chunk.halo[i]]; };
  const auto own = [&](size_t i) -> const glm::uvec3& { return surface.triangles[chunk.first_own + i]; };
  measure_faces(chunk.halo_count, halo, positions_mm, faces);
  Four* const own_faces = faces + 2 * chunk.halo_count;
  measure_faces(chunk.own_count, own, positions_mm, own_faces);
  for (size_t i = 0; i < chunk.own_count; ++i) areas_mm2[chunk.first_own + i] = own_faces[2 * i][3];
  for (uint32_t slot = chunk.first_slot; slot < chunk.end_slot; ++slot) {
    Four vector_area{}, weighted{};
    for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
      const Four* face = faces + size_t{2} * chunk.corners[k];
      vector_area += face[0];
      weighted += face[1];
    }
    const uint32_t vertex = surface.vertex_of_slot[slot];
    const Four position = load3(&positions_mm[vertex].x);
    const Four third = vector_area * (1.0f / 3);
    const float area = vector_area[3];
    auto* place = reinterpret_cast<float*>(&tree.places[slot]);
    store4(place, __builtin_shufflevector(position, third, 0, 1, 2, 7));
    store4(place + 4, third * Four{1, 1, 1, 0});
    store3(&tree.sources[slot].position_mm.x, area > 0 ? 0.5f * (position + weighted * (1 / area)) : position);
    if (normals == nullptr) continue;
    const Four squares = vector_area * vector_area;
    const float length2 = squares[0] + squares[1] + squares[2];
    store3(&normals[vertex].x, length2 > 0 ? vector_area * (1 / std::sqrt(length2)) : Four{0, 0, 1, 0});
  }
}

Colour sum_flux(const ChunkOfTriangles& chunk, const SurfaceTopology& surface, const glm::vec3* irradiance,
                const float* areas_mm2, NodeTree& tree, Four* power) {
  const auto power_of = [&](uint32_t t) HWY_ATTR { return areas_mm2[t] * (1.0f / 3) * load3(&irradiance[t].x); };
  for (size_t i = 0; i < chunk.halo_count; ++i) power[i] = power_of(chunk.halo[i]);
  for (size_t i = 0; i < chunk.own_count; ++i) {
    power[chunk.halo_count + i] = power_of(static_cast<uint32_t>(chunk.first_own + i));
  }
  Colour colour;
  for (uint32_t slot = chunk.first_slot; slot < chunk.end_slot; ++slot) {
    Four flux{};
    for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
      flux += power[chunk.corners[k]];
    }
    store3(&tree.sources[slot].flux_w.x, flux);
    colour.add(flux);
  }
  return colour;
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::diffusion {
HWY_EXPORT(sum_positions);
HWY_EXPORT(sum_flux);

VertexSums::VertexSums(const SurfaceTopology& surface)
    : surface_(surface), corners_(surface.triangle_of_corner.size()), areas_mm2_(surface.triangles.size()) {
  const auto smallest_slot = [&](const glm::uvec3& t) {
    return std::min({surface.slot_of_vertex[t.x], surface.slot_of_vertex[t.y], surface.slot_of_vertex[t.z]});
  };
  first_own_.push_back(0);
  first_halo_.push_back(0);
  for (uint32_t slot = 0; slot < surface.slot_count; slot += NodeTree::kChunkSlots) {
    const uint32_t end_slot = std::min(slot + NodeTree::kChunkSlots, surface.slot_count);
    const uint32_t first_own = first_own_.back();
    uint32_t end_own = first_own;
    while (end_own < surface.triangles.size() && smallest_slot(surface.triangles[end_own]) < end_slot) ++end_own;
    const auto begin = surface.triangle_of_corner.begin() + surface.first_corner[slot];
    const auto end = surface.triangle_of_corner.begin() + surface.first_corner[end_slot];
    std::vector<uint32_t> halo;
    std::copy_if(begin, end, std::back_inserter(halo), [&](uint32_t t) { return t < first_own; });
    std::sort(halo.begin(), halo.end());
    halo.erase(std::unique(halo.begin(), halo.end()), halo.end());
    std::transform(begin, end, corners_.begin() + surface.first_corner[slot], [&](uint32_t t) {
      if (t >= first_own) return static_cast<uint32_t>(halo.size()) + t - first_own;
      return static_cast<uint32_t>(std::lower_bound(halo.begin(), halo.end(), t) - halo.begin());
    });
    halo_.insert(halo_.end(), halo.begin(), halo.end());
    first_own_.push_back(end_own);
    first_halo_.push_back(static_cast<uint32_t>(halo_.size()));
  }
}

ChunkOfTriangles VertexSums::chunk_of(uint32_t chunk, Scratch& scratch) const {
  const uint32_t first_slot = chunk * NodeTree::kChunkSlots;
  const ChunkOfTriangles triangles{first_slot,
                                   std::min(first_slot + NodeTree::kChunkSlots, surface_.slot_count),
                                   halo_.data() + first_halo_[chunk],
                                   first_halo_[chunk + 1] - first_halo_[chunk],
                                   first_own_[chunk],
                                   first_own_[chunk + 1] - first_own_[chunk],
                                   corners_.data()};
  const size_t room = 2 * (triangles.halo_count + triangles.own_count + 4);
  if (scratch.size() < room) scratch.resize(room);
  return triangles;
}

void VertexSums::sum_positions(uint32_t chunk, std::span<const glm::vec3> positions_mm, std::span<glm::vec3> normals,
                               NodeTree& tree, Scratch& scratch) {
  const ChunkOfTriangles triangles = chunk_of(chunk, scratch);
  HWY_DYNAMIC_DISPATCH(sum_positions)
  (triangles, surface_, positions_mm.data(), normals.empty() ? nullptr : normals.data(), areas_mm2_.data(), tree,
   scratch.data());
  if (triangles.end_slot < surface_.slot_count) return;
  for (uint32_t slot = surface_.slot_count; slot < tree.places.size(); ++slot) {
    tree.places[slot] = {tree.places[surface_.slot_count - 1].position_mm};
    tree.sources[slot].position_mm = tree.sources[surface_.slot_count - 1].position_mm;
  }
}

Colour VertexSums::sum_flux(uint32_t chunk, std::span<const glm::vec3> irradiance_at_triangles, NodeTree& tree,
                            Scratch& scratch) const {
  const ChunkOfTriangles triangles = chunk_of(chunk, scratch);
  return HWY_DYNAMIC_DISPATCH(sum_flux)(triangles, surface_, irradiance_at_triangles.data(), areas_mm2_.data(), tree,
                                        scratch.data());
}

size_t VertexSums::bytes() const {
  return sizeof(uint32_t) * (first_own_.size() + first_halo_.size() + halo_.size() + corners_.size()) +
         sizeof(float) * areas_mm2_.size();
}

}  // namespace diaphane::diffusion
#endif

#include "render/refined_mesh.h"

#include <algorithm>
#include <cmath>

#include "diffusion/kernel_table.h"
#include "glm/geometric.hpp"
#include "render/generation.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

// Bounds what a few triangles of a large body can make of themselves.
constexpr uint32_t kMaxVertices = 100'000;

/// The smallest spacing over the distance on which the kernel is smooth: what linear interpolation across triangles
/// leaves of the error falls with it, and so does flicker where a pose stretches triangles (docs/integral.md).
float share_of_smooth_distance(diffusion::Quality quality) {
  return quality == diffusion::Quality::kFine ? 0.38f : 1.0f;
}

/// The next quarter of an octave below, so that small changes do not split anew.
float quarter_octave(float value) { return std::exp2(std::floor(4 * std::log2(value)) / 4); }

}  // namespace

void RefinedMesh::lay_out(geometry::SubdividedMesh refined, uint32_t original_count) {
  original_count_ = original_count;
  ordered_ = diffusion::lay_out(*diffusion::build_surface_topology(std::move(refined.topology)));
  const std::vector<uint32_t>& source = ordered_.source_of_vertex;
  std::vector<uint32_t> moved_to(source.size());
  for (uint32_t v = 0; v < source.size(); ++v) moved_to[source[v]] = v;
  midpoints_.clear();
  std::vector<size_t> generation(source.size(), 0);
  for (uint32_t i = 0; i < refined.parents.size(); ++i) {
    const glm::uvec2& p = refined.parents[i];
    const size_t own = std::max(generation[p.x], generation[p.y]) + 1;
    generation[original_count + i] = own;
    if (midpoints_.size() < own) midpoints_.emplace_back();
    midpoints_[own - 1].push_back({moved_to[original_count + i], moved_to[p.x], moved_to[p.y]});
  }
  for (std::vector<Midpoint>& midpoints : midpoints_) {
    std::sort(midpoints.begin(), midpoints.end(),
              [](const Midpoint& a, const Midpoint& b) { return a.vertex < b.vertex; });
  }
}

/// Calls work(midpoint), parents before children, spread over all cores.
template <typename Work>
void RefinedMesh::for_each_midpoint(const Work& work) const {
  for (const std::vector<Midpoint>& midpoints : midpoints_) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, midpoints.size(), 2048),
                      [&](const tbb::blocked_range<size_t>& range) {
                        for (size_t i = range.begin(); i != range.end(); ++i) work(midpoints[i]);
                      });
  }
}

void RefinedMesh::carry_over(const geometry::PlacedShape& placed) {
  const std::vector<uint32_t>& source = ordered_.source_of_vertex;
  normals_given_ = !placed.normals.empty();
  shape_.flipped = placed.flipped;
  shape_.positions_mm.resize(source.size());
  shape_.normals.resize(source.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, source.size(), 4096), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t v = range.begin(); v != range.end(); ++v) {
      if (source[v] >= original_count_) continue;
      shape_.positions_mm[v] = placed.positions_mm[source[v]];
      if (normals_given_) shape_.normals[v] = placed.normals[source[v]];
    }
  });
  for_each_midpoint([&](const Midpoint& m) {
    shape_.positions_mm[m.vertex] = 0.5f * (shape_.positions_mm[m.a] + shape_.positions_mm[m.b]);
  });
  if (normals_given_) complete_normals();
}

template <typename T>
std::vector<T> RefinedMesh::carry(const std::vector<T>& values) const {
  if (values.empty()) return {};
  const std::vector<uint32_t>& source = ordered_.source_of_vertex;
  std::vector<T> carried(source.size());
  for (size_t v = 0; v < source.size(); ++v) {
    if (source[v] < original_count_) carried[v] = values[source[v]];
  }
  for_each_midpoint([&](const Midpoint& m) { carried[m.vertex] = 0.5f * (carried[m.a] + carried[m.b]); });
  return carried;
}

geometry::SurfaceAttributes RefinedMesh::carry(const geometry::SurfaceAttributes& attributes) const {
  return {carry(attributes.texture_coordinates), carry(attributes.colors)};
}

void RefinedMesh::complete_normals() {
  if (!normals_given_ && shape_.flipped) {
    for (glm::vec3& n : shape_.normals) n = -n;
  }
  for_each_midpoint([&](const Midpoint& m) {
    const glm::vec3 sum = shape_.normals[m.a] + shape_.normals[m.b];
    const float length = glm::length(sum);
    shape_.normals[m.vertex] = length > 1e-6f ? sum / length : shape_.normals[m.a];
  });
}

absl::Status RefinedMesh::update(const scene::Mesh& mesh, PlacedMesh& placed, const optics::Coefficients& material,
                                 diffusion::Quality quality, StageClock& clock) {
  const std::shared_ptr<const geometry::MeshTopology>& topology = mesh.topology;
  const glm::vec3 smooth_mm = diffusion::smooth_distance_mm(optics::make_profile(material));
  const float spacing_mm =
      share_of_smooth_distance(quality) * quarter_octave(std::min({smooth_mm.x, smooth_mm.y, smooth_mm.z}));
  const float unit_mm = quarter_octave(std::max(placed.unit_mm(), 1e-12f));
  const bool new_topology = original_.lock() != topology;
  const bool split_again = splitting_reads_.renew({unit_mm, spacing_mm}) || new_topology;
  if (split_again) {
    const absl::Status split = clock.run("refine", [&]() -> absl::Status {
      std::vector<glm::vec3> rest_mm = topology->uploaded_positions;
      for (glm::vec3& p : rest_mm) p *= unit_mm;
      auto refined = geometry::subdivide(topology, rest_mm,
                                         {.smallest_spacing_mm = spacing_mm,
                                          .largest_spacing_mm = 2 * spacing_mm,
                                          .max_vertices = std::max(kMaxVertices, topology->vertex_count)});
      if (!refined.ok()) return refined.status();
      lay_out(*std::move(refined), topology->vertex_count);
      return absl::OkStatus();
    });
    if (!split.ok()) {
      original_.reset();
      return split;
    }
    original_ = topology;
  }
  if (!shape_reads_.renew(placed.generation()) && !split_again) {
    clock.sleep("refine");
    return absl::OkStatus();
  }
  generation_ = next_generation();
  if (!mesh.shape->normals.empty()) placed.complete_normals(clock);
  clock.run("refine", [&] { carry_over(placed.shape()); });
  return absl::OkStatus();
}

}  // namespace diaphane::render

#include "render/refined_mesh.h"

#include <algorithm>
#include <cmath>

#include "diffusion/kernel_table.h"
#include "render/generation.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

// Bounds what a few triangles of a large body can make of themselves.
constexpr uint32_t kMaxVertices = 100'000;

/// The next quarter of an octave below, so that small changes do not split anew.
float quarter_octave(float value) { return std::exp2(std::floor(4 * std::log2(value)) / 4); }

}  // namespace

void RefinedMesh::carry_over(const geometry::PlacedShape& placed) {
  const std::vector<uint32_t>& source = ordered_.source_of_vertex;
  const geometry::PlacedShape* from = &placed;
  if (!parents_.empty()) {
    extended_ = placed;
    geometry::extend_positions(parents_, extended_.positions_mm);
    geometry::extend_normals(parents_, extended_.normals);
    from = &extended_;
  }
  normals_known_ = !from->normals.empty();
  shape_.flipped = placed.flipped;
  shape_.positions_mm.resize(source.size());
  shape_.normals.resize(source.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, source.size(), 4096), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t v = range.begin(); v != range.end(); ++v) {
      shape_.positions_mm[v] = from->positions_mm[source[v]];
      if (normals_known_) shape_.normals[v] = from->normals[source[v]];
    }
  });
}

absl::Status RefinedMesh::update(const scene::Mesh& mesh, PlacedMesh& placed, const optics::Coefficients& material,
                                 StageClock& clock) {
  const std::shared_ptr<const geometry::MeshTopology>& topology = mesh.topology;
  const glm::vec3 smooth_mm = diffusion::smooth_distance_mm(optics::make_dipole(material));
  const float spacing_mm = quarter_octave(std::min({smooth_mm.x, smooth_mm.y, smooth_mm.z}));
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
      parents_ = std::move(refined->parents);
      ordered_ = diffusion::lay_out(*diffusion::build_surface_topology(std::move(refined->topology)));
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
  if (!mesh.shape->normals.empty() || !parents_.empty()) placed.complete_normals(clock);
  clock.run("refine", [&] { carry_over(placed.shape()); });
  return absl::OkStatus();
}

}  // namespace diaphane::render

#include "render/refined_mesh.h"

#include <algorithm>
#include <cmath>

#include "diffusion/kernel_table.h"

namespace diaphane::render {
namespace {

// Bounds what a few triangles of a large body can make of themselves.
constexpr uint32_t kMaxVertices = 100'000;

/// The next quarter of an octave below, so that small changes do not split anew.
float quarter_octave(float value) { return std::exp2(std::floor(4 * std::log2(value)) / 4); }

}  // namespace

absl::Status RefinedMesh::update(const std::shared_ptr<const geometry::MeshTopology>& topology,
                                 const PlacedMesh& placed, const optics::Coefficients& material, StageClock& clock) {
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
      refined_ = *std::move(refined);
      return absl::OkStatus();
    });
    if (!split.ok()) return split;
    original_ = topology;
  }
  if (!shape_reads_.renew({refined_.topology.get(), placed.generation()}) && !split_again) {
    clock.sleep("refine");
    return absl::OkStatus();
  }
  ++generation_;
  shape_ = &placed.shape();
  if (refined_.parents.empty()) return absl::OkStatus();
  clock.run("refine", [&] {
    extended_ = placed.shape();
    geometry::extend_positions(refined_.parents, extended_.positions_mm);
    geometry::extend_normals(refined_.parents, extended_.normals);
  });
  shape_ = &extended_;
  return absl::OkStatus();
}

}  // namespace diaphane::render

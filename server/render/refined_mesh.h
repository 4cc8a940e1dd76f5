// A mesh as the integral wants it: large triangles split, so that the light in them is resolved, and laid out in the
// order of its tree.
#pragma once

#include <memory>
#include <span>
#include <tuple>

#include "absl/status/status.h"
#include "diffusion/surface_topology.h"
#include "geometry/subdivide.h"
#include "optics/dipole.h"
#include "render/memo.h"
#include "render/placed_mesh.h"

namespace diaphane::render {

/// Splits and lays out once per topology, size and material (see docs/integral.md), and carries every pose over. One
/// thread.
class RefinedMesh {
 public:
  /// Takes `placed`'s normals where the client gave some or triangles are split, else leaves them to whoever fills
  /// normals_to_fill(). Stage: refine.
  absl::Status update(const scene::Mesh& mesh, PlacedMesh& placed, const optics::Coefficients& material,
                      StageClock& clock);

  const std::shared_ptr<const diffusion::SurfaceTopology>& surface() const { return ordered_.surface; }
  const std::shared_ptr<const geometry::MeshTopology>& topology() const { return ordered_.surface->mesh; }
  const geometry::PlacedShape& shape() const { return shape_; }
  /// Room for shape().normals of the present generation; empty where they are known.
  std::span<glm::vec3> normals_to_fill() { return normals_known_ ? std::span<glm::vec3>() : shape_.normals; }
  /// Another number whenever topology or shape change; no two meshes ever share one.
  uint64_t generation() const { return generation_; }

 private:
  void carry_over(const geometry::PlacedShape& placed);

  std::vector<glm::uvec2> parents_;  ///< of the vertices that splitting added
  diffusion::OrderedSurface ordered_;
  geometry::PlacedShape extended_;  ///< before the layout; unused while no triangle is split
  geometry::PlacedShape shape_;
  bool normals_known_ = false;
  std::weak_ptr<const geometry::MeshTopology> original_;
  Memo<std::tuple<float, float>> splitting_reads_;  ///< scale of a mesh unit in mm and spacing in mm, both in steps
  Memo<uint64_t> shape_reads_;
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

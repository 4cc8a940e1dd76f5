// A mesh as the integral wants it: large triangles split, so that the light in them is resolved, and laid out in the
// order of its tree.
#pragma once

#include <memory>
#include <span>
#include <tuple>

#include "absl/status/status.h"
#include "diffusion/dipole_integral.h"
#include "diffusion/surface_topology.h"
#include "geometry/subdivide.h"
#include "geometry/surface_attributes.h"
#include "optics/dipole.h"
#include "render/memo.h"
#include "render/placed_mesh.h"

namespace diaphane::render {

/// Splits and lays out once per topology, size, material and quality (see docs/integral.md), and carries every pose
/// over. One thread.
class RefinedMesh {
 public:
  /// Takes the normals that the client gave; else leaves them to whoever calls fill_normals(). Stage: refine.
  absl::Status update(const scene::Mesh& mesh, PlacedMesh& placed, const optics::Coefficients& material,
                      diffusion::Quality quality, StageClock& clock);

  const std::shared_ptr<const diffusion::SurfaceTopology>& surface() const { return ordered_.surface; }
  const std::shared_ptr<const geometry::MeshTopology>& topology() const { return ordered_.surface->mesh; }
  const geometry::PlacedShape& shape() const { return shape_; }
  /// Where the client gave no normals: calls fill(span) with room for area-weighted ones of the unmirrored triangles,
  /// and makes of them shape().normals, interpolated along split edges. Else calls fill(nothing).
  template <typename Fill>
  void fill_normals(const Fill& fill) {
    fill(normals_given_ ? std::span<glm::vec3>() : std::span<glm::vec3>(shape_.normals));
    if (!normals_given_) complete_normals();
  }
  /// Those of the mesh, for the vertices of topology(): interpolated along split edges.
  geometry::SurfaceAttributes carry(const geometry::SurfaceAttributes& attributes) const;
  /// Another number whenever topology or shape change; no two meshes ever share one.
  uint64_t generation() const { return generation_; }

 private:
  /// A vertex half way between two others that are of generations before its own.
  struct Midpoint {
    uint32_t vertex, a, b;
  };
  template <typename Work>
  void for_each_midpoint(const Work& work) const;
  template <typename T>
  std::vector<T> carry(const std::vector<T>& values) const;
  void lay_out(geometry::SubdividedMesh refined, uint32_t original_count);
  void carry_over(const geometry::PlacedShape& placed);
  void complete_normals();

  diffusion::OrderedSurface ordered_;
  uint32_t original_count_ = 0;                   ///< sources below are the mesh's own vertices
  std::vector<std::vector<Midpoint>> midpoints_;  ///< by generation, then by vertex
  geometry::PlacedShape shape_;
  bool normals_given_ = false;
  std::weak_ptr<const geometry::MeshTopology> original_;
  Memo<std::tuple<float, float>> splitting_reads_;  ///< scale of a mesh unit in mm and spacing in mm, both in steps
  Memo<uint64_t> shape_reads_;
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

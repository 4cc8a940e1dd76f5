// A mesh with its large triangles split, so that the integral resolves the light in them.
#pragma once

#include <memory>
#include <tuple>

#include "absl/status/status.h"
#include "geometry/subdivide.h"
#include "optics/dipole.h"
#include "render/memo.h"
#include "render/placed_mesh.h"

namespace diaphane::render {

/// Splits once per topology, size and material (see docs/integral.md), and carries every pose over. One thread.
class RefinedMesh {
 public:
  /// `placed` is the mesh's own shape, and outlives the next use. Stage: refine.
  absl::Status update(const std::shared_ptr<const geometry::MeshTopology>& topology, const PlacedMesh& placed,
                      const optics::Coefficients& material, StageClock& clock);

  const std::shared_ptr<const geometry::MeshTopology>& topology() const { return refined_.topology; }
  const geometry::PlacedShape& shape() const { return *shape_; }
  /// Grows whenever topology or shape change.
  uint64_t generation() const { return generation_; }

 private:
  geometry::SubdividedMesh refined_;
  geometry::PlacedShape extended_;  ///< unused while no triangle is split
  const geometry::PlacedShape* shape_ = nullptr;
  std::weak_ptr<const geometry::MeshTopology> original_;
  Memo<std::tuple<float, float>> splitting_reads_;  ///< scale of a mesh unit in mm and spacing in mm, both in steps
  Memo<std::tuple<const void*, uint64_t>> shape_reads_;
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

// Where a surface bends sharply or ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "geometry/topology.h"
#include "glm/vec3.hpp"

namespace diaphane::geometry {

/// Answers how far a point is from the nearest crease, to a quarter of `reach_mm`.
class CreaseField {
 public:
  /// Creases of `mesh` at `positions_mm`: edges of the welded surface between triangles whose normals differ by more
  /// than 30°, and edges with one triangle or more than two.
  CreaseField(const MeshTopology& mesh, std::span<const glm::vec3> positions_mm, float reach_mm);

  /// Distance in mm, or reach_mm where no crease is nearer. Thread-safe.
  float distance_mm(const glm::vec3& point_mm) const;

 private:
  struct Cell {
    int64_t x, y, z;
    friend bool operator==(const Cell&, const Cell&) = default;
    template <class H>
    friend H AbslHashValue(H h, const Cell& cell) {
      return H::combine(std::move(h), cell.x, cell.y, cell.z);
    }
  };

  Cell cell_of(const glm::vec3& point_mm, float size_mm) const;
  void add_segment(const glm::vec3& a, const glm::vec3& b);

  float reach_mm_;
  float step_mm_;
  absl::flat_hash_set<Cell> sampled_;                                 ///< cells of step_mm
  absl::flat_hash_map<Cell, std::vector<glm::vec3>> points_of_cell_;  ///< cells of reach_mm
};

}  // namespace diaphane::geometry

#include <gtest/gtest.h>

#include <algorithm>

#include "diffusion/surface_topology.h"
#include "tests/support/meshes.h"

namespace diaphane::diffusion {
namespace {

using Corners = std::array<std::array<float, 3>, 3>;

/// Triangles by where their corners are, each begun at its smallest, all sorted.
std::vector<Corners> places_of(const geometry::MeshTopology& mesh) {
  std::vector<Corners> places;
  for (const glm::uvec3& t : mesh.triangles) {
    Corners corners;
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.uploaded_positions[t[k]];
      corners[static_cast<size_t>(k)] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    places.push_back(corners);
  }
  std::sort(places.begin(), places.end());
  return places;
}

TEST(LayOut, KeepsTheSurfaceAndPutsVerticesInTheOrderOfTheirSlots) {
  const testing::Mesh box = testing::make_box({20, 20, 20}, 2);
  const auto mesh = *geometry::build_topology(box.positions_mm, box.triangles);
  const auto before = build_surface_topology(mesh);
  const OrderedSurface ordered = lay_out(*before);
  const SurfaceTopology& after = *ordered.surface;
  EXPECT_EQ(places_of(*after.mesh), places_of(*mesh));
  EXPECT_TRUE(std::is_sorted(after.slot_of_vertex.begin(), after.slot_of_vertex.end()));
  EXPECT_EQ(after.twins.size(), before->twins.size());
  EXPECT_FALSE(after.twins.empty()) << "a box has vertices apart at its edges";
  for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
    EXPECT_EQ(after.mesh->uploaded_positions[v], mesh->uploaded_positions[ordered.source_of_vertex[v]]);
  }
  for (uint32_t slot = 0; slot < after.slot_count; ++slot) {
    EXPECT_EQ(after.mesh->uploaded_positions[after.vertex_of_slot[slot]],
              mesh->uploaded_positions[before->vertex_of_slot[slot]]);
  }
}

}  // namespace
}  // namespace diaphane::diffusion

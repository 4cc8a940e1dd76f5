#include "geometry/topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "base/status.h"
#include "fmt/format.h"
#include "glm/geometric.hpp"

namespace diaphane::geometry {
namespace {

// Squares of coordinates, and sums of them, must stay finite in float.
constexpr float kLargestCoordinate = 1e18f;

using PositionBits = std::array<uint32_t, 3>;

PositionBits bits_of(const glm::vec3& p) {
  return {std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z)};
}

void weld(MeshTopology& mesh) {
  absl::flat_hash_map<PositionBits, uint32_t> weld_of_position;
  weld_of_position.reserve(mesh.vertex_count);
  mesh.weld_of_vertex.resize(mesh.vertex_count);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const auto next = static_cast<uint32_t>(weld_of_position.size());
    mesh.weld_of_vertex[v] = weld_of_position.try_emplace(bits_of(mesh.uploaded_positions[v]), next).first->second;
  }
  mesh.weld_count = static_cast<uint32_t>(weld_of_position.size());
}

void list_triangles_of_welds(MeshTopology& mesh) {
  mesh.first_triangle.assign(mesh.weld_count + 1, 0);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++mesh.first_triangle[mesh.weld_of_vertex[t[k]] + 1];
  }
  for (uint32_t w = 0; w < mesh.weld_count; ++w) mesh.first_triangle[w + 1] += mesh.first_triangle[w];
  std::vector<uint32_t> next(mesh.first_triangle.begin(), mesh.first_triangle.end() - 1);
  mesh.triangle_of_weld.resize(mesh.triangles.size() * 3);
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) mesh.triangle_of_weld[next[mesh.weld_of_vertex[mesh.triangles[t][k]]]++] = t;
  }
}

/// The corner of `t` after weld `w`, or w itself where `t` has no area by its indices or does not touch it.
uint32_t weld_after(const MeshTopology& mesh, const glm::uvec3& t, uint32_t w) {
  for (int k = 0; k < 3; ++k) {
    if (mesh.weld_of_vertex[t[k]] == w) return mesh.weld_of_vertex[t[(k + 1) % 3]];
  }
  return w;
}

bool has_distinct_welds(const MeshTopology& mesh, const glm::uvec3& t) {
  const uint32_t a = mesh.weld_of_vertex[t.x], b = mesh.weld_of_vertex[t.y], c = mesh.weld_of_vertex[t.z];
  return a != b && b != c && c != a;
}

/// How many triangles run the edge from weld `a` to weld `b` in this direction.
int count_directed(const MeshTopology& mesh, uint32_t a, uint32_t b) {
  int count = 0;
  for (uint32_t k = mesh.first_triangle[a]; k < mesh.first_triangle[a + 1]; ++k) {
    const glm::uvec3& t = mesh.triangles[mesh.triangle_of_weld[k]];
    count += has_distinct_welds(mesh, t) && weld_after(mesh, t, a) == b ? 1 : 0;
  }
  return count;
}

/// Six times the volume behind the triangles, about the first vertex.
double volume6(const MeshTopology& mesh) {
  const auto& p = mesh.uploaded_positions;
  const glm::dvec3 origin = p.front();
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    sum += glm::dot(glm::dvec3(p[t.x]) - origin, glm::cross(glm::dvec3(p[t.y]) - origin, glm::dvec3(p[t.z]) - origin));
  }
  return sum;
}

bool encloses_volume(const MeshTopology& mesh) {
  // Fans of thousands of triangles around one vertex are not worth the time.
  constexpr uint32_t kLargestFan = 256;
  for (const glm::uvec3& t : mesh.triangles) {
    if (!has_distinct_welds(mesh, t)) continue;
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = mesh.weld_of_vertex[t[k]], b = mesh.weld_of_vertex[t[(k + 1) % 3]];
      if (mesh.first_triangle[b + 1] - mesh.first_triangle[b] > kLargestFan) return false;
      if (count_directed(mesh, b, a) != 1) return false;
    }
  }
  return volume6(mesh) > 0;
}

}  // namespace

absl::Status check_finite(std::span<const glm::vec3> values, std::string_view field) {
  // All at once first: edits come by the hundred thousand positions. Magnitudes order like their bits, NaN above all.
  if (values.empty()) return absl::OkStatus();
  int32_t beyond = 0;
  for (const float value : std::span(&values.front().x, 3 * values.size())) {
    beyond |= (std::bit_cast<int32_t>(value) & 0x7fffffff) > std::bit_cast<int32_t>(kLargestCoordinate) ? -1 : 0;
  }
  if (beyond == 0) return absl::OkStatus();
  for (size_t i = 0; i < values.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      // Written so that NaN fails too.
      if (!(std::abs(values[i][axis]) <= kLargestCoordinate)) {
        return base::invalid_field(fmt::format("{}[{}].{}", field, i, "xyz"[axis]), "finite, within ±1e18",
                                   values[i][axis]);
      }
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<std::shared_ptr<const MeshTopology>> build_topology(std::vector<glm::vec3> positions,
                                                                   std::vector<glm::uvec3> triangles) {
  if (triangles.empty()) return base::invalid_field("triangle_count", "at least 1", 0);
  if (absl::Status finite = check_finite(positions, "positions"); !finite.ok()) return finite;
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (triangles[t][k] >= positions.size()) {
        return base::invalid_field(fmt::format("indices[{}]", 3 * t + k),
                                   fmt::format("below vertex_count {}", positions.size()), triangles[t][k]);
      }
    }
  }
  auto mesh = std::make_shared<MeshTopology>();
  mesh->vertex_count = static_cast<uint32_t>(positions.size());
  mesh->triangles = std::move(triangles);
  mesh->uploaded_positions = std::move(positions);
  weld(*mesh);
  list_triangles_of_welds(*mesh);
  mesh->encloses_volume = encloses_volume(*mesh);
  return std::shared_ptr<const MeshTopology>(std::move(mesh));
}

}  // namespace diaphane::geometry

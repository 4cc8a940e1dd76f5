#include "geometry/subdivide.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "geometry/creases.h"
#include "glm/geometric.hpp"

namespace diaphane::geometry {
namespace {

constexpr float kTolerance = 1.2f;
constexpr uint32_t kUnsplit = ~uint32_t{0};

/// Halves edges of a growing mesh, round after round.
class Splitter {
 public:
  Splitter(const MeshTopology& mesh, std::span<const glm::vec3> positions_mm, const CreaseField& creases,
           const SubdivisionOptions& options)
      : creases_(creases),
        options_(options),
        positions_mm_(positions_mm.begin(), positions_mm.end()),
        triangles_(mesh.triangles) {}

  /// False, at once, when the mesh would outgrow its bound.
  bool run() {
    while (true) {
      const size_t before = positions_mm_.size();
      for (const glm::uvec3& t : triangles_) {
        for (int k = 0; k < 3; ++k) decide(t[k], t[(k + 1) % 3]);
        if (positions_mm_.size() > options_.max_vertices) return false;
      }
      if (positions_mm_.size() == before) return true;
      split_triangles();
    }
  }

  std::vector<glm::uvec2> take_parents() { return std::move(parents_); }
  std::vector<glm::uvec3> take_triangles() { return std::move(triangles_); }

 private:
  static uint64_t edge_key(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  bool is_long(const glm::vec3& a, const glm::vec3& b) const {
    const float length = glm::length(b - a);
    if (!(length > kTolerance * options_.smallest_spacing_mm)) return false;
    if (length > kTolerance * options_.largest_spacing_mm) return true;
    const float wanted = 0.5f * creases_.distance_mm(0.5f * (a + b));
    return length > kTolerance * std::max(wanted, options_.smallest_spacing_mm);
  }

  /// Symmetric in its ends and blind to the vertices' names: all sides of an edge agree, also across a seam.
  void decide(uint32_t a, uint32_t b) {
    const auto [entry, is_new] = middle_of_edge_.try_emplace(edge_key(a, b), kUnsplit);
    if (!is_new || !is_long(positions_mm_[a], positions_mm_[b])) return;
    entry->second = static_cast<uint32_t>(positions_mm_.size());
    parents_.emplace_back(std::min(a, b), std::max(a, b));
    positions_mm_.push_back(0.5f * (positions_mm_[a] + positions_mm_[b]));
  }

  uint32_t middle(uint32_t a, uint32_t b) const { return middle_of_edge_.at(edge_key(a, b)); }

  void split_triangles() {
    std::vector<glm::uvec3> next;
    next.reserve(2 * triangles_.size());
    for (const glm::uvec3& t : triangles_) split(t, next);
    triangles_ = std::move(next);
  }

  void split(glm::uvec3 t, std::vector<glm::uvec3>& out) const {
    glm::uvec3 m(middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x));
    const int halved = (m.x != kUnsplit) + (m.y != kUnsplit) + (m.z != kUnsplit);
    if (halved == 0) return out.push_back(t);
    if (halved == 3) {
      out.insert(out.end(), {{t.x, m.x, m.z}, {m.x, t.y, m.y}, {m.z, m.y, t.z}, m});
      return;
    }
    // Turned so that the first edge is the one halved, or the last the one not halved.
    while (halved == 1 ? m.x == kUnsplit : m.z != kUnsplit) {
      t = {t.y, t.z, t.x};
      m = {m.y, m.z, m.x};
    }
    if (halved == 1) {
      out.insert(out.end(), {{t.x, m.x, t.z}, {m.x, t.y, t.z}});
      return;
    }
    out.push_back({m.x, t.y, m.y});
    const auto length = [&](uint32_t a, uint32_t b) { return glm::length(positions_mm_[a] - positions_mm_[b]); };
    if (length(t.x, m.y) < length(m.x, t.z)) {
      out.insert(out.end(), {{t.x, m.x, m.y}, {t.x, m.y, t.z}});
    } else {
      out.insert(out.end(), {{t.x, m.x, t.z}, {m.x, m.y, t.z}});
    }
  }

  const CreaseField& creases_;
  const SubdivisionOptions options_;
  std::vector<glm::vec3> positions_mm_;
  std::vector<glm::uvec3> triangles_;
  std::vector<glm::uvec2> parents_;
  absl::flat_hash_map<uint64_t, uint32_t> middle_of_edge_;  ///< of every edge there was: none is judged twice
};

/// The least largest spacing that the bound on vertices allows: every edge, and every square of the surface, needs
/// some.
float least_spacing(const MeshTopology& mesh, std::span<const glm::vec3> positions_mm, uint32_t max_vertices) {
  double length = 0, area = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(positions_mm[t.x]), b(positions_mm[t.y]), c(positions_mm[t.z]);
    length += 0.5 * (glm::length(b - a) + glm::length(c - b) + glm::length(a - c));
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return static_cast<float>(std::max(length / (2.0 * kTolerance * max_vertices),
                                     std::sqrt(area / (2.0 * kTolerance * kTolerance * max_vertices))));
}

}  // namespace

absl::StatusOr<SubdividedMesh> subdivide(std::shared_ptr<const MeshTopology> mesh,
                                         std::span<const glm::vec3> positions_mm, const SubdivisionOptions& options) {
  SubdivisionOptions bounded = options;
  if (bounded.max_vertices == 0) {
    bounded.max_vertices = static_cast<uint32_t>(
        std::min<uint64_t>(std::max<uint64_t>(500000, uint64_t{4} * mesh->vertex_count), 1u << 31));
  }
  bounded.max_vertices = std::max(bounded.max_vertices, mesh->vertex_count);
  const float scale =
      std::max(1.0f, least_spacing(*mesh, positions_mm, bounded.max_vertices) / bounded.largest_spacing_mm);
  bounded.smallest_spacing_mm *= scale;
  bounded.largest_spacing_mm *= scale;
  while (true) {
    const CreaseField creases(*mesh, positions_mm, 2 * bounded.largest_spacing_mm);
    Splitter splitter(*mesh, positions_mm, creases, bounded);
    if (splitter.run()) {
      SubdividedMesh result;
      result.parents = splitter.take_parents();
      if (result.parents.empty()) return SubdividedMesh{std::move(mesh), {}};
      std::vector<glm::vec3> rest = mesh->uploaded_positions;
      extend_positions(result.parents, rest);
      auto topology = build_topology(std::move(rest), splitter.take_triangles());
      if (!topology.ok()) return topology.status();
      result.topology = *std::move(topology);
      return result;
    }
    bounded.smallest_spacing_mm *= 2;
    bounded.largest_spacing_mm *= 2;
  }
}

void extend_positions(std::span<const glm::uvec2> parents, std::vector<glm::vec3>& positions) {
  positions.reserve(positions.size() + parents.size());
  for (const glm::uvec2& p : parents) positions.push_back(0.5f * (positions[p.x] + positions[p.y]));
}

void extend_normals(std::span<const glm::uvec2> parents, std::vector<glm::vec3>& normals) {
  normals.reserve(normals.size() + parents.size());
  for (const glm::uvec2& p : parents) {
    const glm::vec3 sum = normals[p.x] + normals[p.y];
    const float length = glm::length(sum);
    normals.push_back(length > 1e-6f ? sum / length : normals[p.x]);
  }
}

}  // namespace diaphane::geometry

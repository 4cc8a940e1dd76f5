#include "geometry/creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "glm/common.hpp"
#include "glm/geometric.hpp"

namespace diaphane::geometry {
namespace {

constexpr float kCosineOfCrease = 0.8660254f;  // 30°

struct Edge {
  uint32_t low_weld, high_weld;
  uint32_t triangle;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

std::vector<Edge> sorted_edges(const MeshTopology& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = mesh.weld_of_vertex[mesh.triangles[t][k]];
      const uint32_t b = mesh.weld_of_vertex[mesh.triangles[t][(k + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), t});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// A cell's neighbours and itself, faces before edges before corners.
std::array<glm::ivec3, 27> steps_inside_out() {
  std::array<glm::ivec3, 27> steps;
  for (int i = 0; i < 27; ++i) steps[i] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
  std::stable_sort(steps.begin(), steps.end(), [](const glm::ivec3& a, const glm::ivec3& b) {
    return glm::dot(glm::vec3(a), glm::vec3(a)) < glm::dot(glm::vec3(b), glm::vec3(b));
  });
  return steps;
}

const std::array<glm::ivec3, 27> kStepsInsideOut = steps_inside_out();

}  // namespace

CreaseField::CreaseField(const MeshTopology& mesh, std::span<const glm::vec3> positions_mm, float reach_mm)
    : reach_mm_(reach_mm), step_mm_(reach_mm / 8) {
  std::vector<uint32_t> vertex_of_weld(mesh.weld_count);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) vertex_of_weld[mesh.weld_of_vertex[v]] = v;
  const auto area_vector = [&](uint32_t t) {
    const glm::uvec3& v = mesh.triangles[t];
    return glm::cross(positions_mm[v.y] - positions_mm[v.x], positions_mm[v.z] - positions_mm[v.x]);
  };
  const std::vector<Edge> edges = sorted_edges(mesh);
  for (size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end].low_weld == edges[first].low_weld &&
           edges[end].high_weld == edges[first].high_weld) {
      ++end;
    }
    bool crease = end - first != 2;
    if (!crease) {
      const glm::vec3 a = area_vector(edges[first].triangle), b = area_vector(edges[first + 1].triangle);
      crease = glm::dot(a, b) < kCosineOfCrease * glm::length(a) * glm::length(b);
    }
    if (crease) {
      add_segment(positions_mm[vertex_of_weld[edges[first].low_weld]],
                  positions_mm[vertex_of_weld[edges[first].high_weld]]);
    }
  }
}

CreaseField::Cell CreaseField::cell_of(const glm::vec3& point_mm, float size_mm) const {
  const auto index = [&](float x) {
    return static_cast<int64_t>(std::clamp(std::floor(static_cast<double>(x) / size_mm), -9e18, 9e18));
  };
  return {index(point_mm.x), index(point_mm.y), index(point_mm.z)};
}

void CreaseField::add_segment(const glm::vec3& a, const glm::vec3& b) {
  const auto steps = static_cast<int64_t>(std::ceil(static_cast<double>(glm::length(b - a)) / step_mm_));
  for (int64_t i = 0; i <= steps; ++i) {
    const float t = steps > 0 ? static_cast<float>(static_cast<double>(i) / static_cast<double>(steps)) : 0;
    const glm::vec3 point = a + t * (b - a);
    // One point for each step-sized cell is enough.
    if (sampled_.insert(cell_of(point, step_mm_)).second) points_of_cell_[cell_of(point, reach_mm_)].push_back(point);
  }
}

float CreaseField::distance_mm(const glm::vec3& point_mm) const {
  if (points_of_cell_.empty()) return reach_mm_;
  const Cell centre = cell_of(point_mm, reach_mm_);
  const glm::vec3 inside(glm::dvec3(point_mm) - double{reach_mm_} * glm::dvec3(centre.x, centre.y, centre.z));
  float nearest2 = reach_mm_ * reach_mm_;
  // The own cell first: where creases are dense, hardly another is near enough to be looked at.
  for (const glm::ivec3& step : kStepsInsideOut) {
    const glm::vec3 gap =
        glm::max(glm::max(glm::vec3(step) * reach_mm_ - inside, inside - glm::vec3(step + 1) * reach_mm_), 0.0f);
    if (glm::dot(gap, gap) >= nearest2) continue;
    const auto found = points_of_cell_.find(Cell{centre.x + step.x, centre.y + step.y, centre.z + step.z});
    if (found == points_of_cell_.end()) continue;
    for (const glm::vec3& p : found->second) nearest2 = std::min(nearest2, glm::dot(p - point_mm, p - point_mm));
  }
  return std::sqrt(nearest2);
}

}  // namespace diaphane::geometry

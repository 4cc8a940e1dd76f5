#include "diffusion/surface_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "glm/geometric.hpp"

namespace diaphane::diffusion {
namespace {

constexpr uint32_t kLargestUnsplit = 4;

/// How far, in vertex spacings, a unit normal pushes a vertex away from one that faces the other way. What is cut into
/// leaves is eight spacings wide: the two sides of a thin sheet come apart before they would share a leaf.
constexpr float kNormalWeight = 5.0f;

/// A weld to be ordered: its rest position, its normal times a length, and its name to break ties.
struct Point {
  std::array<float, 6> coordinates;
  uint32_t weld;
};

size_t longest_axis(const Point* begin, const Point* end) {
  std::array<float, 6> lowest = begin->coordinates, highest = begin->coordinates;
  for (const Point* p = begin; p != end; ++p) {
    for (size_t a = 0; a < 6; ++a) {
      lowest[a] = std::min(lowest[a], p->coordinates[a]);
      highest[a] = std::max(highest[a], p->coordinates[a]);
    }
  }
  size_t longest = 0;
  for (size_t a = 1; a < 6; ++a) {
    if (highest[a] - lowest[a] > highest[longest] - lowest[longest]) longest = a;
  }
  return longest;
}

std::vector<Point> points_of(const geometry::MeshTopology& mesh, const std::vector<uint32_t>& vertex_of_weld) {
  std::vector<glm::vec3> area_vectors(mesh.weld_count, glm::vec3(0));
  std::vector<float> areas(mesh.weld_count, 0);
  for (const glm::uvec3& t : mesh.triangles) {
    const auto& p = mesh.uploaded_positions;
    const glm::vec3 area_vector = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]) / 6.0f;
    for (int k = 0; k < 3; ++k) {
      area_vectors[mesh.weld_of_vertex[t[k]]] += area_vector;
      areas[mesh.weld_of_vertex[t[k]]] += glm::length(area_vector);
    }
  }
  std::vector<Point> points(mesh.weld_count);
  for (uint32_t w = 0; w < mesh.weld_count; ++w) {
    const glm::vec3& p = mesh.uploaded_positions[vertex_of_weld[w]];
    const glm::vec3 lean = areas[w] > 0 ? area_vectors[w] * (kNormalWeight / std::sqrt(areas[w])) : glm::vec3(0);
    points[w] = {{p.x, p.y, p.z, lean.x, lean.y, lean.z}, w};
  }
  return points;
}

/// How many of `count` > 4 points go left: a multiple of the largest power of four below `count`, near a half.
size_t left_share(size_t count) {
  size_t power = 4;
  while (power * 4 < count) power *= 4;
  const size_t half = (count + power) / (2 * power) * power;
  const size_t largest = (count - 1) / power * power;
  return std::clamp(half, power, largest);
}

void order(Point* begin, Point* end) {
  while (end - begin > kLargestUnsplit) {
    const size_t axis = longest_axis(begin, end);
    Point* middle = begin + left_share(static_cast<size_t>(end - begin));
    std::nth_element(begin, middle, end, [axis](const Point& a, const Point& b) {
      return a.coordinates[axis] != b.coordinates[axis] ? a.coordinates[axis] < b.coordinates[axis] : a.weld < b.weld;
    });
    order(begin, middle);
    begin = middle;
  }
  // nth_element leaves the last few in an order of its own.
  std::sort(begin, end, [](const Point& a, const Point& b) { return a.weld < b.weld; });
}

std::vector<uint32_t> first_vertices(const geometry::MeshTopology& mesh) {
  std::vector<uint32_t> first(mesh.weld_count, mesh.vertex_count);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    uint32_t& known = first[mesh.weld_of_vertex[v]];
    known = std::min(known, v);
  }
  return first;
}

void sort_triangles(SurfaceTopology& surface) {
  const auto smallest_slot = [&](const glm::uvec3& t) {
    return std::min({surface.slot_of_vertex[t.x], surface.slot_of_vertex[t.y], surface.slot_of_vertex[t.z]});
  };
  const std::vector<glm::uvec3>& triangles = surface.mesh->triangles;
  std::vector<std::pair<uint32_t, uint32_t>> keys(triangles.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) keys[t] = {smallest_slot(triangles[t]), t};
  std::sort(keys.begin(), keys.end());
  surface.triangles.reserve(triangles.size());
  for (const auto& [slot, t] : keys) surface.triangles.push_back(triangles[t]);
}

void list_corners(SurfaceTopology& surface) {
  surface.first_corner.assign(surface.slot_count + 1, 0);
  for (const glm::uvec3& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) ++surface.first_corner[surface.slot_of_vertex[t[k]] + 1];
  }
  std::partial_sum(surface.first_corner.begin(), surface.first_corner.end(), surface.first_corner.begin());
  std::vector<uint32_t> next(surface.first_corner.begin(), surface.first_corner.end() - 1);
  surface.triangle_of_corner.resize(surface.triangles.size() * 3);
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      surface.triangle_of_corner[next[surface.slot_of_vertex[surface.triangles[t][k]]]++] = t;
    }
  }
}

}  // namespace

std::shared_ptr<const SurfaceTopology> build_surface_topology(std::shared_ptr<const geometry::MeshTopology> mesh) {
  auto surface = std::make_shared<SurfaceTopology>();
  surface->mesh = std::move(mesh);
  surface->slot_count = surface->mesh->weld_count;
  surface->vertex_of_slot = first_vertices(*surface->mesh);

  std::vector<Point> points = points_of(*surface->mesh, surface->vertex_of_slot);
  order(points.data(), points.data() + points.size());

  std::vector<uint32_t> slot_of_weld(surface->slot_count);
  const std::vector<uint32_t> vertex_of_weld = surface->vertex_of_slot;
  for (uint32_t slot = 0; slot < surface->slot_count; ++slot) {
    slot_of_weld[points[slot].weld] = slot;
    surface->vertex_of_slot[slot] = vertex_of_weld[points[slot].weld];
  }
  surface->slot_of_vertex.resize(surface->mesh->vertex_count);
  for (uint32_t v = 0; v < surface->mesh->vertex_count; ++v) {
    const uint32_t weld = surface->mesh->weld_of_vertex[v];
    surface->slot_of_vertex[v] = slot_of_weld[weld];
    if (vertex_of_weld[weld] != v) surface->twins.push_back(v);
  }
  sort_triangles(*surface);
  list_corners(*surface);
  return surface;
}

OrderedSurface lay_out(const SurfaceTopology& surface) {
  const geometry::MeshTopology& mesh = *surface.mesh;
  OrderedSurface ordered;
  std::vector<uint32_t>& source = ordered.source_of_vertex;
  source.resize(mesh.vertex_count);
  std::iota(source.begin(), source.end(), 0u);
  std::stable_sort(source.begin(), source.end(),
                   [&](uint32_t a, uint32_t b) { return surface.slot_of_vertex[a] < surface.slot_of_vertex[b]; });
  std::vector<uint32_t> moved_to(mesh.vertex_count);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) moved_to[source[v]] = v;

  auto laid_out = std::make_shared<geometry::MeshTopology>();
  laid_out->vertex_count = mesh.vertex_count;
  laid_out->weld_count = mesh.weld_count;
  laid_out->encloses_volume = mesh.encloses_volume;
  laid_out->first_triangle = surface.first_corner;
  laid_out->triangle_of_weld = surface.triangle_of_corner;
  for (const glm::uvec3& t : surface.triangles) {
    laid_out->triangles.emplace_back(moved_to[t.x], moved_to[t.y], moved_to[t.z]);
  }
  for (const uint32_t v : source) {
    laid_out->uploaded_positions.push_back(mesh.uploaded_positions[v]);
    laid_out->weld_of_vertex.push_back(surface.slot_of_vertex[v]);
  }
  auto result = std::make_shared<SurfaceTopology>();
  result->mesh = laid_out;
  result->slot_count = surface.slot_count;
  result->slot_of_vertex = laid_out->weld_of_vertex;
  result->triangles = laid_out->triangles;
  result->first_corner = surface.first_corner;
  result->triangle_of_corner = surface.triangle_of_corner;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const bool first_of_weld = v == 0 || result->slot_of_vertex[v] != result->slot_of_vertex[v - 1];
    (first_of_weld ? result->vertex_of_slot : result->twins).push_back(v);
  }
  ordered.surface = std::move(result);
  return ordered;
}

}  // namespace diaphane::diffusion

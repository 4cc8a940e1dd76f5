#include "diffusion/surface_topology.h"

#include <algorithm>
#include <numeric>

#include "glm/common.hpp"

namespace diaphane::diffusion {
namespace {

constexpr uint32_t kLargestUnsplit = 4;

/// A weld to be ordered: its rest position, and its name to break ties.
struct Point {
  glm::vec3 position;
  uint32_t weld;
};

int longest_axis(const Point* begin, const Point* end) {
  glm::vec3 lowest = begin->position, highest = begin->position;
  for (const Point* p = begin; p != end; ++p) {
    lowest = glm::min(lowest, p->position);
    highest = glm::max(highest, p->position);
  }
  const glm::vec3 extent = highest - lowest;
  int axis = extent.y > extent.x ? 1 : 0;
  if (extent.z > extent[axis]) axis = 2;
  return axis;
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
    const int axis = longest_axis(begin, end);
    Point* middle = begin + left_share(static_cast<size_t>(end - begin));
    std::nth_element(begin, middle, end, [axis](const Point& a, const Point& b) {
      return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.weld < b.weld;
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

  std::vector<Point> points(surface->slot_count);
  for (uint32_t w = 0; w < surface->slot_count; ++w) {
    points[w] = {surface->mesh->uploaded_positions[surface->vertex_of_slot[w]], w};
  }
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

}  // namespace diaphane::diffusion

#include "tests/support/meshes.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "geometry/shape.h"
#include "geometry/topology.h"
#include "glm/geometric.hpp"

namespace diaphane::testing {
namespace {

std::optional<Mesh> read_ply(std::ifstream& file) {
  Mesh mesh;
  std::string line;
  while (std::getline(file, line) && line != "end_header") {
    if (line.starts_with("element vertex ")) mesh.positions_mm.resize(std::stoul(line.substr(15)));
    if (line.starts_with("element face ")) mesh.triangles.resize(std::stoul(line.substr(13)));
  }
  file.read(reinterpret_cast<char*>(mesh.positions_mm.data()),
            static_cast<std::streamsize>(mesh.positions_mm.size() * sizeof(glm::vec3)));
  for (glm::uvec3& triangle : mesh.triangles) {
    file.get();
    file.read(reinterpret_cast<char*>(&triangle), sizeof(triangle));
  }
  return file ? std::optional(mesh) : std::nullopt;
}

std::optional<Mesh> read_off(std::ifstream& file) {
  Mesh mesh;
  std::string magic;
  size_t vertices = 0, faces = 0, edges = 0;
  file >> magic >> vertices >> faces >> edges;
  mesh.positions_mm.resize(vertices);
  for (glm::vec3& p : mesh.positions_mm) file >> p.x >> p.y >> p.z;
  mesh.triangles.resize(faces);
  for (glm::uvec3& t : mesh.triangles) file >> edges >> t.x >> t.y >> t.z;
  return file ? std::optional(mesh) : std::nullopt;
}

}  // namespace

std::string shared_path(const std::string& below) { return std::string(DIAPHANE_SOURCE_DIR) + "/../shared/" + below; }

std::optional<Mesh> read_obj_gz(const std::string& path) {
  gzFile file = gzopen(path.c_str(), "rb");
  if (!file) return std::nullopt;
  Mesh mesh;
  char line[256];
  while (gzgets(file, line, sizeof(line))) {
    glm::vec3 v;
    glm::uvec3 t;
    if (std::sscanf(line, "vn %f %f %f", &v.x, &v.y, &v.z) == 3) {
      mesh.normals.push_back(v);
    } else if (std::sscanf(line, "v %f %f %f", &v.x, &v.y, &v.z) == 3) {
      mesh.positions_mm.push_back(v);
    } else if (std::sscanf(line, "f %u//%*u %u//%*u %u", &t.x, &t.y, &t.z) == 3) {
      mesh.triangles.push_back(t - 1u);
    }
  }
  gzclose(file);
  if (mesh.positions_mm.size() != mesh.normals.size()) return std::nullopt;
  return mesh;
}

std::optional<Mesh> read_mesh(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::optional<Mesh> mesh = path.ends_with(".ply") ? read_ply(file) : read_off(file);
  if (mesh) compute_normals(*mesh);
  return mesh;
}

void scale_to(Mesh& mesh, float extent_mm) {
  const geometry::Bounds bounds = geometry::bounds_of(mesh.positions_mm);
  const glm::vec3 extent = bounds.highest - bounds.lowest;
  const float scale = extent_mm / std::max({extent.x, extent.y, extent.z});
  const glm::vec3 centre = 0.5f * (bounds.lowest + bounds.highest);
  for (glm::vec3& p : mesh.positions_mm) p = (p - centre) * scale;
}

float radius_of(const Mesh& mesh) {
  float radius = 0;
  for (const glm::vec3& p : mesh.positions_mm) radius = std::max(radius, glm::length(p));
  return radius;
}

void compute_normals(Mesh& mesh) {
  const auto topology = geometry::build_topology(mesh.positions_mm, mesh.triangles);
  mesh.normals = geometry::compute_normals(**topology, mesh.positions_mm);
}

Mesh make_torus(float ring_radius_mm, float tube_radius_mm, int around, int across) {
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around);
      const float v = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(across);
      const glm::vec3 n(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
      mesh.positions_mm.push_back(ring_radius_mm * glm::vec3(std::cos(u), std::sin(u), 0) + tube_radius_mm * n);
      mesh.normals.push_back(n);
      const auto at = [&](int a, int b) { return static_cast<uint32_t>((a % around) * across + b % across); };
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

Mesh make_cup(float radius_mm, float height_mm, float wall_mm, float spacing_mm) {
  // The outline from the outer floor's centre to the inner floor's, corners cut off by a quarter of the wall.
  const float r = radius_mm, h = height_mm, w = wall_mm, c = 0.25f * wall_mm;
  const std::vector<std::pair<float, float>> corners = {{0, 0},         {r - c, 0},     {r, c},         {r, h - c},
                                                        {r - c, h},     {r - w + c, h}, {r - w, h - c}, {r - w, w + c},
                                                        {r - w - c, w}, {0, w}};
  std::vector<std::pair<float, float>> outline;
  for (size_t k = 0; k + 1 < corners.size(); ++k) {
    const auto [r0, z0] = corners[k];
    const auto [r1, z1] = corners[k + 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(r1 - r0, z1 - z0) / spacing_mm)));
    for (int i = k == 0 ? 1 : 0; i < steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      outline.emplace_back(r0 + t * (r1 - r0), z0 + t * (z1 - z0));
    }
  }
  const int around = static_cast<int>(std::ceil(2 * std::numbers::pi_v<float> * radius_mm / spacing_mm));
  Mesh mesh;
  for (const auto& [ring, z] : outline) {
    for (int i = 0; i < around; ++i) {
      const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around);
      mesh.positions_mm.emplace_back(ring * std::cos(u), ring * std::sin(u), z - 0.5f * height_mm);
    }
  }
  const auto at = [&](size_t k, int i) {
    return static_cast<uint32_t>(k * static_cast<size_t>(around)) + static_cast<uint32_t>(i % around);
  };
  for (size_t k = 0; k + 1 < outline.size(); ++k) {
    for (int i = 0; i < around; ++i) {
      mesh.triangles.emplace_back(at(k, i), at(k, i + 1), at(k + 1, i + 1));
      mesh.triangles.emplace_back(at(k, i), at(k + 1, i + 1), at(k + 1, i));
    }
  }
  const auto cap = [&](float z, size_t ring, bool below) {
    const auto centre = static_cast<uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.emplace_back(0, 0, z - 0.5f * height_mm);
    for (int i = 0; i < around; ++i) {
      below ? mesh.triangles.emplace_back(centre, at(ring, i + 1), at(ring, i))
            : mesh.triangles.emplace_back(centre, at(ring, i), at(ring, i + 1));
    }
  };
  cap(0, 0, true);
  cap(w, outline.size() - 1, false);
  compute_normals(mesh);
  return mesh;
}

Mesh make_box(const glm::vec3& extent_mm, float spacing_mm) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto columns = static_cast<uint32_t>(std::ceil(extent_mm[u] / spacing_mm));
    const auto rows = static_cast<uint32_t>(std::ceil(extent_mm[v] / spacing_mm));
    for (int side = -1; side <= 1; side += 2) {
      glm::vec3 normal(0);
      normal[axis] = static_cast<float>(side);
      const auto first = static_cast<uint32_t>(mesh.positions_mm.size());
      for (uint32_t j = 0; j <= rows; ++j) {
        for (uint32_t i = 0; i <= columns; ++i) {
          // The far side runs backwards, so that all triangles run counter-clockwise.
          glm::vec3 p = normal;
          p[u] = static_cast<float>(side) * (2 * static_cast<float>(i) / static_cast<float>(columns) - 1);
          p[v] = 2 * static_cast<float>(j) / static_cast<float>(rows) - 1;
          mesh.positions_mm.push_back(0.5f * extent_mm * p);
          mesh.normals.push_back(normal);
        }
      }
      const uint32_t stride = columns + 1;
      for (uint32_t j = 0; j < rows; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
          const uint32_t a = first + j * stride + i;
          mesh.triangles.emplace_back(a, a + 1, a + stride + 1);
          mesh.triangles.emplace_back(a, a + stride + 1, a + stride);
        }
      }
    }
  }
  return mesh;
}

Mesh make_graded_disc(float first_ring_mm, float radius_mm, int sectors) {
  Mesh mesh;
  mesh.positions_mm.emplace_back(0);
  const float step = 2 * std::numbers::pi_v<float> / static_cast<float>(sectors);
  uint32_t rings = 0;
  // Even rings until their spacing equals the arc between sectors, then a constant ratio.
  for (float r = first_ring_mm; r < radius_mm; r += std::max(first_ring_mm, r * step)) {
    for (int i = 0; i < sectors; ++i) {
      const float u = step * static_cast<float>(i);
      mesh.positions_mm.emplace_back(r * std::cos(u), r * std::sin(u), 0);
    }
    ++rings;
  }
  const auto n = static_cast<uint32_t>(sectors);
  for (uint32_t i = 0; i < n; ++i) {
    mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % n);
    for (uint32_t k = 0; k + 1 < rings; ++k) {
      const uint32_t a = 1 + k * n + i, b = 1 + k * n + (i + 1) % n;
      mesh.triangles.emplace_back(a, a + n, b + n);
      mesh.triangles.emplace_back(a, b + n, b);
    }
  }
  mesh.normals.assign(mesh.positions_mm.size(), glm::vec3(0, 0, 1));
  return mesh;
}

std::vector<SurfacePoint> random_points(const Mesh& mesh, size_t count, uint32_t seed) {
  std::vector<double> area_up_to;
  double area = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    area += glm::length(
        glm::cross(mesh.positions_mm[t.y] - mesh.positions_mm[t.x], mesh.positions_mm[t.z] - mesh.positions_mm[t.x]));
    area_up_to.push_back(area);
  }
  std::mt19937 bits(seed);
  const auto uniform = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  std::vector<SurfacePoint> points(count);
  for (SurfacePoint& point : points) {
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end(), uniform() * area);
    point.triangle = static_cast<uint32_t>(
        std::min<ptrdiff_t>(found - area_up_to.begin(), static_cast<ptrdiff_t>(area_up_to.size()) - 1));
    const double root = std::sqrt(uniform()), v = uniform();
    point.weights = {1 - root, root * (1 - v), root * v};
  }
  return points;
}

glm::vec3 interpolate(const Mesh& mesh, const std::vector<glm::vec3>& values, const SurfacePoint& point) {
  const glm::uvec3& t = mesh.triangles[point.triangle];
  return point.weights.x * values[t.x] + point.weights.y * values[t.y] + point.weights.z * values[t.z];
}

glm::vec3 relative_rms(const std::vector<glm::vec3>& values, const std::vector<glm::vec3>& truth) {
  glm::dvec3 squares(0), sum(0);
  for (size_t i = 0; i < truth.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(values[i]) - glm::dvec3(truth[i]);
    squares += difference * difference;
    sum += glm::dvec3(truth[i]);
  }
  const auto n = static_cast<double>(truth.size());
  return {std::sqrt(squares.x / n) / (sum.x / n), std::sqrt(squares.y / n) / (sum.y / n),
          std::sqrt(squares.z / n) / (sum.z / n)};
}

}  // namespace diaphane::testing

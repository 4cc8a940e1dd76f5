// Meshes that tests and benches measure on: the shared files, read without ado, and shapes made here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glm/vec3.hpp"

namespace diaphane::testing {

/// A triangle mesh in mm with outward unit normals, one for each vertex.
struct Mesh {
  std::vector<glm::vec3> positions_mm;
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> triangles;
};

/// Where shared data lies: "data/meshes/hand_7k7.ply" below it, for example.
std::string shared_path(const std::string& below);

/// A Wavefront file packed by gzip whose faces are v//n with v = n, or nothing where it is absent.
std::optional<Mesh> read_obj_gz(const std::string& path);

/// A binary PLY of float positions and triangles, or an OFF of triangles; normals are computed. Nothing where it is
/// absent.
std::optional<Mesh> read_mesh(const std::string& path);

/// Moves the bounds' centre to the origin and scales the longest extent to `extent_mm`.
void scale_to(Mesh& mesh, float extent_mm);

/// The distance of the farthest vertex from the origin, mm.
float radius_of(const Mesh& mesh);

/// Replaces the normals by area-weighted ones of the welded surface.
void compute_normals(Mesh& mesh);

/// A torus about z.
Mesh make_torus(float ring_radius_mm, float tube_radius_mm, int around, int across);

/// A cup about z, open above: a cylinder with a bore that leaves walls and a floor of `wall_mm`, edges rounded, spacing
/// about `spacing_mm`.
Mesh make_cup(float radius_mm, float height_mm, float wall_mm, float spacing_mm);

/// A box whose faces are grids of squares about `spacing_mm` wide, each cut in two; hard edges (vertices apart by
/// face).
Mesh make_box(const glm::vec3& extent_mm, float spacing_mm);

/// A disc in the plane z = 0 that is fine in the middle and grows outward by rings of constant ratio.
Mesh make_graded_disc(float first_ring_mm, float radius_mm, int sectors);

/// Points chosen evenly by area: a triangle and barycentric weights each. The same for the same seed.
struct SurfacePoint {
  uint32_t triangle;
  glm::vec3 weights;
};
std::vector<SurfacePoint> random_points(const Mesh& mesh, size_t count, uint32_t seed);

/// Σ weights × values at the point's triangle.
glm::vec3 interpolate(const Mesh& mesh, const std::vector<glm::vec3>& values, const SurfacePoint& point);

/// RMS difference over mean of `truth`, by channel.
glm::vec3 relative_rms(const std::vector<glm::vec3>& values, const std::vector<glm::vec3>& truth);

}  // namespace diaphane::testing

#include "geometry/subdivide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "geometry/creases.h"
#include "glm/geometric.hpp"
#include "glm/vec4.hpp"

namespace diaphane::geometry {
namespace {

/// A cube of side 2 about the origin: 12 triangles; each face has its own vertices, unless `shared`.
std::shared_ptr<const MeshTopology> cube(bool shared) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  const glm::uvec4 faces[6] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<glm::vec3> positions = shared ? corners : std::vector<glm::vec3>{};
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec4& f : faces) {
    glm::uvec4 v = f;
    if (!shared) {
      for (int k = 0; k < 4; ++k) {
        v[k] = static_cast<uint32_t>(positions.size());
        positions.push_back(corners[f[k]]);
      }
    }
    triangles.emplace_back(v.x, v.y, v.z);
    triangles.emplace_back(v.x, v.z, v.w);
  }
  return *build_topology(positions, triangles);
}

/// Every edge of the welded surface has exactly two triangles.
void expect_closed(const MeshTopology& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> balance, uses;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = mesh.weld_of_vertex[t[k]], b = mesh.weld_of_vertex[t[(k + 1) % 3]];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      ++uses[{std::min(a, b), std::max(a, b)}];
    }
  }
  for (const auto& [edge, sum] : balance) ASSERT_EQ(sum, 0) << "orientation";
  for (const auto& [edge, count] : uses) ASSERT_EQ(count, 2) << "T-junction";
}

double area(const MeshTopology& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto& p = mesh.uploaded_positions;
    sum += 0.5 * glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
  }
  return sum;
}

float longest_edge(const MeshTopology& mesh) {
  float longest = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, glm::length(mesh.uploaded_positions[t[k]] - mesh.uploaded_positions[t[(k + 1) % 3]]));
    }
  }
  return longest;
}

TEST(Subdivision, LeavesNoLongEdgeAndNoGap) {
  for (const bool shared : {false, true}) {
    const auto mesh = cube(shared);
    const auto fine =
        subdivide(mesh, mesh->uploaded_positions, {.smallest_spacing_mm = 0.1f, .largest_spacing_mm = 0.3f});
    ASSERT_TRUE(fine.ok());
    expect_closed(*fine->topology);
    EXPECT_LE(longest_edge(*fine->topology), 1.2f * 0.3f);
    EXPECT_NEAR(area(*fine->topology), 24, 1e-4);
    EXPECT_EQ(fine->topology->vertex_count, mesh->vertex_count + fine->parents.size());
  }
}

TEST(Subdivision, IsFinerAtCreases) {
  const auto mesh = cube(false);
  const auto fine =
      subdivide(mesh, mesh->uploaded_positions, {.smallest_spacing_mm = 0.05f, .largest_spacing_mm = 0.4f});
  ASSERT_TRUE(fine.ok());
  float at_crease = 0, in_middle = 10;
  for (const glm::uvec3& t : fine->topology->triangles) {
    const auto& p = fine->topology->uploaded_positions;
    const glm::vec3 centre = glm::abs((p[t.x] + p[t.y] + p[t.z]) / 3.0f);
    const float length = glm::length(p[t.y] - p[t.x]);
    std::array<float, 3> sorted = {centre.x, centre.y, centre.z};
    std::sort(sorted.begin(), sorted.end());
    if (sorted[1] > 0.97f) at_crease = std::max(at_crease, length);
    if (sorted[1] < 0.1f) in_middle = std::min(in_middle, length);
  }
  EXPECT_LE(at_crease, 0.1f);
  EXPECT_GE(in_middle, 0.2f);
}

TEST(Subdivision, ReturnsTheMeshItselfWhereNothingIsLong) {
  const auto mesh = cube(true);
  const auto fine = subdivide(mesh, mesh->uploaded_positions, {.smallest_spacing_mm = 3, .largest_spacing_mm = 6});
  ASSERT_TRUE(fine.ok());
  EXPECT_EQ(fine->topology, mesh);
  EXPECT_TRUE(fine->parents.empty());
}

TEST(Subdivision, StaysBelowItsBoundHoweverFineItIsAsked) {
  const auto mesh = cube(true);
  const auto fine = subdivide(mesh, mesh->uploaded_positions,
                              {.smallest_spacing_mm = 1e-7f, .largest_spacing_mm = 1e-6f, .max_vertices = 5000});
  ASSERT_TRUE(fine.ok());
  EXPECT_LE(fine->topology->vertex_count, 5000u);
  EXPECT_GE(fine->topology->vertex_count, 500u);
  expect_closed(*fine->topology);
}

TEST(Subdivision, BoundsNeedlesWithoutArea) {
  const auto mesh = build_topology({{0, 0, 0}, {1e12f, 0, 0}, {2e12f, 0, 0}}, {{0, 1, 2}});
  const auto fine = subdivide(*mesh, (*mesh)->uploaded_positions,
                              {.smallest_spacing_mm = 0.1f, .largest_spacing_mm = 1, .max_vertices = 1000});
  ASSERT_TRUE(fine.ok());
  EXPECT_LE(fine->topology->vertex_count, 1000u);
}

TEST(Subdivision, CarriesAnotherPose) {
  const auto mesh = cube(true);
  const auto fine =
      subdivide(mesh, mesh->uploaded_positions, {.smallest_spacing_mm = 0.3f, .largest_spacing_mm = 0.5f});
  std::vector<glm::vec3> moved = mesh->uploaded_positions;
  for (glm::vec3& p : moved) p = p * 2.0f + glm::vec3(1, 2, 3);
  std::vector<glm::vec3> normals(8);
  for (size_t v = 0; v < 8; ++v) normals[v] = glm::normalize(mesh->uploaded_positions[v]);
  extend_positions(fine->parents, moved);
  extend_normals(fine->parents, normals);
  ASSERT_EQ(moved.size(), fine->topology->vertex_count);
  ASSERT_EQ(normals.size(), fine->topology->vertex_count);
  for (size_t v = 0; v < moved.size(); ++v) {
    const glm::vec3 expected = fine->topology->uploaded_positions[v] * 2.0f + glm::vec3(1, 2, 3);
    EXPECT_LE(glm::length(moved[v] - expected), 1e-5f);
    EXPECT_NEAR(glm::length(normals[v]), 1, 1e-5f);
  }
}

TEST(Creases, AreFoundAtSharpEdgesAndBoundaries) {
  const auto mesh = cube(false);
  const CreaseField field(*mesh, mesh->uploaded_positions, 0.8f);
  EXPECT_NEAR(field.distance_mm({1, 1, 0}), 0, 0.1f);
  EXPECT_NEAR(field.distance_mm({1, 0.5f, 0}), 0.5f, 0.1f);
  EXPECT_EQ(field.distance_mm({1, 0, 0}), 0.8f);
  const auto sheet = build_topology({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const CreaseField boundary(**sheet, (*sheet)->uploaded_positions, 0.4f);
  EXPECT_NEAR(boundary.distance_mm({0.3f, 0.1f, 0}), 0.1f, 0.05f);
}

}  // namespace
}  // namespace diaphane::geometry

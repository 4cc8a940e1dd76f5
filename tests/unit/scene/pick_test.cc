#include "scene/pick.h"

#include <gtest/gtest.h>

#include "glm/ext/matrix_transform.hpp"
#include "glm/geometric.hpp"

namespace diaphane::scene {
namespace {

/// A square of side 2 about the origin that looks along +z, as two triangles.
std::shared_ptr<Mesh> square(const std::string& name, const glm::mat4& scene_from_mesh = glm::mat4(1)) {
  const std::vector<glm::vec3> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  auto mesh = std::make_shared<Mesh>();
  mesh->name = name;
  mesh->scene_from_mesh = scene_from_mesh;
  mesh->topology = geometry::build_topology(corners, {{0, 1, 2}, {0, 2, 3}}).value();
  mesh->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{corners, {}});
  return mesh;
}

SceneSnapshot with(std::vector<std::shared_ptr<const Mesh>> meshes) {
  SceneSnapshot scene;
  scene.meshes = std::move(meshes);
  return scene;
}

// At a distance of 2, 90 degrees show 4 by 4 units.
const Camera kCamera{{0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 90};
const glm::uvec2 kSize{400, 400};

TEST(Pick, SaysWhereAndInWhichShares) {
  const auto seen = pick(with({square("a")}), kCamera, kSize, {250, 130});
  ASSERT_TRUE(seen.has_value());
  EXPECT_EQ(seen->mesh, "a");
  EXPECT_EQ(seen->triangle, 1u);  // above the diagonal
  EXPECT_NEAR(glm::distance(seen->position, glm::dvec3(0.5, 0.7, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(seen->facet_normal, glm::dvec3(0, 0, 1)), 0, 1e-12);
  EXPECT_NEAR(seen->distance, std::sqrt(0.25 + 0.49 + 4), 1e-12);
  const glm::vec3 shares = seen->barycentric;
  EXPECT_NEAR(shares.x + shares.y + shares.z, 1, 1e-6);
  const glm::vec3 made =
      shares.x * glm::vec3(-1, -1, 0) + shares.y * glm::vec3(1, 1, 0) + shares.z * glm::vec3(-1, 1, 0);
  EXPECT_NEAR(glm::distance(made, glm::vec3(0.5, 0.7, 0)), 0, 1e-6);
}

TEST(Pick, IsNothingBesideTheSurfaceOrBehindTheEye) {
  EXPECT_FALSE(pick(with({square("a")}), kCamera, kSize, {301, 200}).has_value());
  Camera away = kCamera;
  away.target = {0, 0, 4};
  EXPECT_FALSE(pick(with({square("a")}), away, kSize, {200, 200}).has_value());
  EXPECT_FALSE(pick(with({}), kCamera, kSize, {200, 200}).has_value());
}

TEST(Pick, TakesTheNearestOfSeveralPlacedMeshes) {
  const glm::mat4 nearer = glm::scale(glm::translate(glm::mat4(1), {0, 0, 1}), {0.25f, 0.5f, 3});
  const SceneSnapshot scene = with({square("far"), square("near", nearer)});
  EXPECT_EQ(pick(scene, kCamera, kSize, {200, 200.5})->mesh, "near");
  EXPECT_NEAR(pick(scene, kCamera, kSize, {200, 200.5})->distance, 1, 1e-5);
  EXPECT_EQ(pick(scene, kCamera, kSize, {270, 200.5})->mesh, "far");
}

TEST(Pick, SeesBackSidesAndMirroredMeshesWithNormalsToTheEye) {
  const glm::mat4 turned = glm::rotate(glm::mat4(1), glm::radians(180.0f), {0, 1, 0});
  const glm::mat4 mirrored = glm::scale(glm::mat4(1), {-1, 1, 1});
  for (const glm::mat4& placed : {turned, mirrored}) {
    const auto seen = pick(with({square("a", placed)}), kCamera, kSize, {210, 190});
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(seen->facet_normal.z, 1, 1e-6);
  }
}

TEST(Pick, PassesOverTrianglesWithoutArea) {
  auto mesh = square("a");
  mesh->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{std::vector<glm::vec3>(4, {0, 0, 0}), {}});
  EXPECT_FALSE(pick(with({mesh}), kCamera, kSize, {200, 200}).has_value());
}

}  // namespace
}  // namespace diaphane::scene

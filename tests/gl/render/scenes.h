// Scenes and requests for the GL tests.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "render/frame.h"

namespace diaphane::render {

struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// A square in z = 0, `cells` × `cells` quads, centred, facing +z.
inline Triangles make_plane(float side, uint32_t cells) {
  Triangles plane;
  for (uint32_t j = 0; j <= cells; ++j) {
    for (uint32_t i = 0; i <= cells; ++i) {
      plane.positions.emplace_back(side * (static_cast<float>(i) / cells - 0.5f),
                                   side * (static_cast<float>(j) / cells - 0.5f), 0);
    }
  }
  for (uint32_t j = 0; j < cells; ++j) {
    for (uint32_t i = 0; i < cells; ++i) {
      const uint32_t a = j * (cells + 1) + i;
      plane.triangles.emplace_back(a, a + 1, a + cells + 2);
      plane.triangles.emplace_back(a, a + cells + 2, a + cells + 1);
    }
  }
  return plane;
}

/// A closed box centred on the origin, each side `cells` × `cells` quads, with hard edges (vertices apart).
inline Triangles make_box(const glm::vec3& size, uint32_t cells) {
  Triangles box;
  const Triangles side = make_plane(1, cells);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      const auto base = static_cast<uint32_t>(box.positions.size());
      for (const glm::vec3& p : side.positions) {
        glm::vec3 q;
        q[(axis + 1) % 3] = p.x;
        q[(axis + 2) % 3] = p.y;
        q[axis] = 0.5f * sign;
        box.positions.push_back(q * size);
      }
      for (glm::uvec3 t : side.triangles) {
        if (sign < 0) std::swap(t.y, t.z);
        box.triangles.push_back(t + base);
      }
    }
  }
  return box;
}

/// One mesh, in millimetres, of a named material.
inline std::shared_ptr<scene::SceneSnapshot> make_scene(Triangles triangles, std::string_view preset,
                                                        std::vector<glm::vec3> normals = {}) {
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->name = "scenes/test";
  scene->revision = 1;
  scene->materials.push_back(
      {"scenes/test/materials/m", optics::PresetName{std::string(preset)}, optics::find_preset(preset)->coefficients});
  auto mesh = std::make_shared<scene::Mesh>();
  mesh->name = "scenes/test/meshes/a";
  mesh->material = scene->materials.front().name;
  auto shape = std::make_shared<geometry::MeshShape>();
  shape->positions = triangles.positions;
  shape->normals = std::move(normals);
  mesh->shape = std::move(shape);
  mesh->topology = *geometry::build_topology(std::move(triangles.positions), std::move(triangles.triangles));
  scene->meshes.push_back(std::move(mesh));
  return scene;
}

/// A ball about the origin with its exact normals, in scene units.
inline std::shared_ptr<scene::SceneSnapshot> make_ball_scene(float radius, uint32_t cells, std::string_view preset) {
  Triangles ball = make_box({1, 1, 1}, cells);
  std::vector<glm::vec3> normals;
  for (glm::vec3& p : ball.positions) {
    normals.push_back(glm::normalize(p));
    p = radius * normals.back();
  }
  return make_scene(std::move(ball), preset, std::move(normals));
}

inline void add_point_light(scene::SceneSnapshot& scene, const glm::vec3& position, float intensity_w_sr) {
  scene.lights.push_back({"scenes/test/lights/l" + std::to_string(scene.lights.size()),
                          scene::PointLight{position, glm::vec3(intensity_w_sr)}});
}

}  // namespace diaphane::render

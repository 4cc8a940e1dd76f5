#include "tests/bench/timed_scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/cells.h"

namespace diaphane::bench {

const std::vector<std::string>& five_meshes() {
  static const std::vector<std::string> files = {"hand_7k7.ply", "demon_standin_goathead_48k.ply",
                                                 "bunny_closed_72k.ply", "neptune_227k.ply", "buddha_381k.ply"};
  return files;
}

std::vector<scene::Light> lights(bool coloured) {
  if (!coloured) return {{"a", scene::PointLight{kLight, glm::vec3(12000)}}};
  return {{"a", scene::PointLight{{30, 20, 30}, {12000, 3000, 500}}},
          {"b", scene::PointLight{{-30, 10, -20}, {300, 2000, 12000}}}};
}

std::shared_ptr<scene::SceneSnapshot> make_scene(const testing::Mesh& mesh, const std::string& preset,
                                                 std::vector<scene::Light> lights) {
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->name = "scenes/bench";
  const optics::Coefficients material = testing::cell_material(preset);
  scene->materials.push_back({"material", material, material});
  auto body = std::make_shared<scene::Mesh>();
  body->name = "mesh";
  body->material = "material";
  body->topology = *geometry::build_topology(mesh.positions_mm, mesh.triangles);
  scene->meshes.push_back(body);
  scene->lights = std::move(lights);
  return scene;
}

std::vector<glm::vec3> leaning(const testing::Mesh& mesh, int frame) {
  std::vector<glm::vec3> positions = mesh.positions_mm;
  const float share = 0.02f * std::sin(0.3f * static_cast<float>(frame));
  for (glm::vec3& p : positions) p.x += share * p.y;
  return positions;
}

std::shared_ptr<const scene::SceneSnapshot> posed(const scene::SceneSnapshot& scene, std::vector<glm::vec3> positions) {
  auto result = std::make_shared<scene::SceneSnapshot>(scene);
  auto body = std::make_shared<scene::Mesh>(*scene.meshes.front());
  body->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{std::move(positions), {}});
  result->meshes.front() = body;
  return result;
}

scene::Camera orbit(int frame) {
  const float angle = 0.05f * static_cast<float>(frame);
  return {{45 * std::sin(angle), 0, 45 * std::cos(angle)}, {0, 0, 0}, {0, 1, 0}, 30};
}

diffusion::Quality quality_of(const std::string& name) {
  if (name == "draft") return diffusion::Quality::kDraft;
  return name == "normal" ? diffusion::Quality::kNormal : diffusion::Quality::kFine;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace diaphane::bench

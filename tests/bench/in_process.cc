#include "tests/bench/in_process.h"

#include <atomic>
#include <chrono>
#include <cstring>

#include "optics/presets.h"

namespace diaphane::bench {
namespace {

static_assert(sizeof(Vec3) == sizeof(glm::vec3));

glm::vec3 vec3(const Vec3& v) { return {v.x, v.y, v.z}; }

std::vector<glm::vec3> vectors(const std::vector<Vec3>& values) {
  std::vector<glm::vec3> result(values.size());
  std::memcpy(result.data(), values.data(), values.size() * sizeof(Vec3));
  return result;
}

}  // namespace

InProcess::InProcess(render::FrameRenderer& renderer, const MeshData& mesh, double millimetres_per_unit,
                     const PointLight& light)
    : renderer_(renderer) {
  std::vector<glm::uvec3> triangles;
  for (size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    triangles.emplace_back(mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]);
  }
  scene_.name = "scenes/bench";
  scene_.millimetres_per_unit = millimetres_per_unit;
  scene_.materials.push_back({"marble", optics::PresetName{"marble"}, optics::find_preset("marble")->coefficients});
  auto body = std::make_shared<scene::Mesh>();
  body->name = "mesh";
  body->material = "marble";
  body->topology = *geometry::build_topology(vectors(mesh.positions), std::move(triangles));
  scene_.meshes.push_back(std::move(body));
  scene_.lights.push_back(
      {"light", scene::PointLight{vec3(light.position),
                                  {light.intensity_w_sr.r, light.intensity_w_sr.g, light.intensity_w_sr.b}}});
}

absl::StatusOr<double> InProcess::frame_ms(const std::vector<Vec3>& positions, const Camera& camera, const Size& size) {
  const auto begin = std::chrono::steady_clock::now();
  auto body = std::make_shared<scene::Mesh>(*scene_.meshes.front());
  body->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{vectors(positions), {}});
  auto scene = std::make_shared<scene::SceneSnapshot>(scene_);
  scene->meshes.front() = std::move(body);
  render::FrameRequest request;
  request.scene = std::move(scene);
  request.camera = {vec3(camera.eye), vec3(camera.target), vec3(camera.up), camera.fov_y_deg};
  request.width_px = size.width_px;
  request.height_px = size.height_px;
  const auto frame = renderer_.render(request, std::atomic<bool>(false));
  if (!frame.ok()) return frame.status();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace diaphane::bench

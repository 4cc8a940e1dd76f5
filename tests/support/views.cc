#include "tests/support/views.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"

namespace diaphane::testing {

View view_from(const glm::vec3& direction, float radius_mm, uint32_t size_px) {
  View view;
  view.camera.fov_y_deg = 25;
  const float distance = radius_mm / std::sin(glm::radians(0.5f * view.camera.fov_y_deg));
  view.camera.eye = distance * glm::normalize(direction);
  const glm::vec3 along = glm::normalize(direction);
  view.camera.up = std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
  view.size_px = size_px;
  return view;
}

Sights trace(const Mesh& mesh, const MeshRays& rays, const View& view) {
  const scene::Camera& camera = view.camera;
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::vec3 up = glm::cross(right, forward);
  const float half = std::tan(glm::radians(0.5f * camera.fov_y_deg));
  const auto n = static_cast<float>(view.size_px);
  Sights sights{{}, view.size_px, 2 * half * glm::length(camera.eye) / n};
  for (uint32_t y = 0; y < view.size_px; ++y) {
    for (uint32_t x = 0; x < view.size_px; ++x) {
      const float across = 2 * (static_cast<float>(x) + 0.5f) / n - 1,
                  above = 1 - 2 * (static_cast<float>(y) + 0.5f) / n;
      const glm::vec3 way = glm::normalize(forward + half * (across * right + above * up));
      const auto found = rays.first_along(camera.eye, way);
      if (!found) {
        sights.of_pixel.emplace_back();
        continue;
      }
      const glm::vec3 normal = glm::normalize(interpolate(mesh, mesh.normals, *found));
      sights.of_pixel.push_back(
          Sight{interpolate(mesh, mesh.positions_mm, *found), normal, std::abs(glm::dot(normal, way))});
    }
  }
  return sights;
}

bool Sights::is_inside(size_t pixel) const {
  if (!of_pixel[pixel]) return false;
  const Sight& here = *of_pixel[pixel];
  const auto x = static_cast<int>(pixel % size_px), y = static_cast<int>(pixel / size_px);
  for (int j = y - 1; j <= y + 1; ++j) {
    for (int i = x - 1; i <= x + 1; ++i) {
      const auto n = static_cast<int>(size_px);
      if (i < 0 || j < 0 || i >= n || j >= n) return false;
      const auto& there = of_pixel[static_cast<size_t>(j * n + i)];
      if (!there) return false;
      // √2 pixels apart, seen aslant; twice that is a jump.
      const float slant = std::max(std::min(here.cosine, there->cosine), 0.1f);
      if (glm::distance(here.position_mm, there->position_mm) > 2 * 1.5f * pixel_mm / slant) return false;
    }
  }
  return true;
}

std::shared_ptr<scene::SceneSnapshot> make_scene(const Mesh& mesh, const optics::Coefficients& material,
                                                 std::span<const PointLight> lights) {
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->name = "scenes/bench";
  scene->revision = 1;
  scene->materials.push_back({"scenes/bench/materials/m", material, material});
  auto body = std::make_shared<scene::Mesh>();
  body->name = "scenes/bench/meshes/a";
  body->material = scene->materials.front().name;
  body->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{mesh.positions_mm, mesh.normals});
  body->topology = *geometry::build_topology(mesh.positions_mm, mesh.triangles);
  scene->meshes.push_back(std::move(body));
  for (const PointLight& light : lights) {
    scene->lights.push_back({"scenes/bench/lights/l" + std::to_string(scene->lights.size()),
                             scene::PointLight{light.position_mm, light.intensity_w_sr}});
  }
  return scene;
}

std::shared_ptr<scene::SceneSnapshot> with_pose(const scene::SceneSnapshot& scene, const Mesh& pose) {
  auto posed = std::make_shared<scene::SceneSnapshot>(scene);
  auto body = std::make_shared<scene::Mesh>(*scene.meshes.front());
  body->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{pose.positions_mm, pose.normals});
  body->positions_revision = ++posed->revision;
  posed->meshes.front() = std::move(body);
  return posed;
}

render::FrameRequest unshadowed_request(std::shared_ptr<const scene::SceneSnapshot> scene, const View& view,
                                        render::Technique technique, diffusion::Quality quality) {
  render::FrameRequest request;
  request.scene = std::move(scene);
  request.camera = view.camera;
  request.width_px = request.height_px = view.size_px;
  request.settings.technique = technique;
  request.settings.quality = quality;
  request.settings.shadows = false;
  request.format = render::PixelFormat::kLinearFloat;
  return request;
}

std::vector<glm::vec3> radiance_of(render::FrameRenderer& renderer, const render::FrameRequest& request) {
  const absl::StatusOr<render::Frame> frame = renderer.render(request, std::atomic<bool>(false));
  if (!frame.ok()) throw std::runtime_error(std::string(frame.status().message()));
  const auto& values = std::get<base::ImageF>(frame->image).values;
  std::vector<glm::vec3> pixels(values.size() / 4);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2]};
  return pixels;
}

}  // namespace diaphane::testing

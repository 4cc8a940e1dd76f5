#include "scene/pick.h"

#include <cmath>

#include "glm/geometric.hpp"
#include "glm/mat3x3.hpp"
#include "glm/mat4x4.hpp"
#include "glm/matrix.hpp"
#include "glm/trigonometric.hpp"

namespace diaphane::scene {
namespace {

/// origin + t·direction, t > 0; a direction of any length, so that t is the same in every affine frame.
struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0};
};

struct Hit {
  double t = INFINITY;
  glm::dvec3 barycentric{0};
};

/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997; both sides.
std::optional<Hit> meet(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a;
  const glm::dvec3 p = glm::cross(ray.direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return std::nullopt;
  const glm::dvec3 from_a = ray.origin - a;
  const double of_b = glm::dot(from_a, p) / determinant;
  if (!(of_b >= 0 && of_b <= 1)) return std::nullopt;
  const glm::dvec3 q = glm::cross(from_a, ab);
  const double of_c = glm::dot(ray.direction, q) / determinant;
  if (!(of_c >= 0 && of_b + of_c <= 1)) return std::nullopt;
  const double t = glm::dot(ac, q) / determinant;
  if (!(t > 0)) return std::nullopt;
  return Hit{t, {1 - of_b - of_c, of_b, of_c}};
}

/// Through a pixel; its direction reaches as far as the view axis goes in one unit.
Ray ray_through(const Camera& camera, const glm::uvec2& size_px, const glm::vec2& pixel) {
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.eye));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half_height = std::tan(glm::radians(static_cast<double>(camera.fov_y_deg)) / 2);
  const double half_width = half_height * size_px.x / size_px.y;
  const glm::dvec2 screen = 2.0 * glm::dvec2(pixel) / glm::dvec2(size_px) - 1.0;
  return {glm::dvec3(camera.eye), forward + screen.x * half_width * right - screen.y * half_height * up};
}

}  // namespace

std::optional<Picked> pick(const SceneSnapshot& scene, const Camera& camera, const glm::uvec2& size_px,
                           const glm::vec2& pixel) {
  const Ray ray = ray_through(camera, size_px, pixel);
  std::optional<Picked> nearest;
  double nearest_t = INFINITY;
  for (const auto& mesh : scene.meshes) {
    const glm::dmat4 mesh_from_scene = glm::inverse(glm::dmat4(mesh->scene_from_mesh));
    const Ray local{glm::dvec3(mesh_from_scene * glm::dvec4(ray.origin, 1)),
                    glm::dvec3(mesh_from_scene * glm::dvec4(ray.direction, 0))};
    const std::vector<glm::vec3>& positions = mesh->shape->positions;
    const std::vector<glm::uvec3>& triangles = mesh->topology->triangles;
    for (size_t i = 0; i < triangles.size(); ++i) {
      const glm::dvec3 a = positions[triangles[i].x], b = positions[triangles[i].y], c = positions[triangles[i].z];
      const std::optional<Hit> hit = meet(local, a, b, c);
      if (!hit.has_value() || hit->t >= nearest_t) continue;
      nearest_t = hit->t;
      const glm::dvec3 across = glm::transpose(glm::dmat3(mesh_from_scene)) * glm::cross(b - a, c - a);
      const glm::dvec3 normal = glm::normalize(across);
      nearest = Picked{mesh->name,
                       static_cast<uint32_t>(i),
                       glm::vec3(hit->barycentric),
                       ray.origin + hit->t * ray.direction,
                       glm::dot(normal, ray.direction) > 0 ? -normal : normal,
                       hit->t * glm::length(ray.direction)};
    }
  }
  return nearest;
}

}  // namespace diaphane::scene

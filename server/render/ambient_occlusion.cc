#include "render/ambient_occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "optics/dipole.h"
#include "optics/harmonics.h"
#include "render/uniforms.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kPadding = 16;

/// Evenly over the sphere: a spiral of constant area a turn.
glm::vec3 spiral_direction(uint32_t index, uint32_t count) {
  const float y = 1 - (2 * static_cast<float>(index) + 1) / static_cast<float>(count);
  const float radius = std::sqrt(1 - y * y);
  const float angle = std::numbers::pi_v<float> * (3 - std::sqrt(5.0f)) * static_cast<float>(index);
  return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

template <typename Work>
void for_each(size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1024), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

}  // namespace

float AmbientDirections::entering_share(float cosine) const {
  return refractive_index == 1 ? 1.0f : optics::fresnel_transmittance(refractive_index, cosine);
}

AmbientDirections ambient_directions(const Ambient& ambient, float refractive_index, uint32_t count) {
  AmbientDirections directions{refractive_index, {}, {}};
  for (uint32_t k = 0; k < count; ++k) {
    const glm::vec3 towards = spiral_direction(k, count);
    directions.towards.push_back(towards);
    const glm::vec3 of_map = rotated_about_y(towards, -ambient.rotation_deg);
    directions.radiance.push_back(glm::max(optics::evaluate(ambient.light->radiance, of_map), glm::vec3(0)));
  }
  return directions;
}

void AmbientOcclusion::look(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape,
                            ShadowScene& occluders) {
  seen_.resize(kDirections * triangles.size());
  visible_.resize(triangles.size());
  for (uint32_t k = 0; k < kDirections; ++k) {
    const LightStorage light{.position_mm = glm::vec4(spiral_direction(k, kDirections), 0),
                             .power = glm::vec4(0, 0, 0, 1)};
    occluders.visibility(light, triangles, shape, visible_);
    for_each(triangles.size(),
             [&](size_t t) { seen_[kDirections * t + k] = static_cast<uint8_t>(255 * visible_[t] + 0.5f); });
  }
}

void AmbientOcclusion::weigh(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape,
                             const Ambient& ambient, float refractive_index) {
  const AmbientDirections directions = ambient_directions(ambient, refractive_index, kDirections);
  const size_t vertices = shape.positions_mm.size();
  of_triangles_.resize(3 * triangles.size() + kPadding);
  of_vertices_.assign(3 * vertices + kPadding, 0.0f);
  for_each(triangles.size(), [&](size_t t) {
    const glm::uvec3& i = triangles[t];
    const glm::vec3 sum = shape.normals[i.x] + shape.normals[i.y] + shape.normals[i.z];
    const float length = glm::length(sum);
    const glm::vec3 normal = length > 0 ? sum / length : shape.normals[i.x];
    const uint8_t* seen = &seen_[kDirections * t];
    const glm::vec3 share =
        directions.share(normal, [&](size_t k) { return static_cast<float>(seen[k]) * (1.0f / 255); });
    for (int c = 0; c < 3; ++c) of_triangles_[c * triangles.size() + t] = share[c];
  });
  std::vector<float> count(vertices, 0.0f);
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (const uint32_t v : {triangles[t].x, triangles[t].y, triangles[t].z}) {
      ++count[v];
      for (size_t c = 0; c < 3; ++c) of_vertices_[c * vertices + v] += of_triangles_[c * triangles.size() + t];
    }
  }
  for_each(vertices, [&](size_t v) {
    for (size_t c = 0; c < 3; ++c) {
      float& share = of_vertices_[c * vertices + v];
      share = count[v] > 0 ? share / count[v] : 1.0f;
    }
  });
}

}  // namespace diaphane::render

#include "render/vertex_light.h"

#include <algorithm>

#include "glm/geometric.hpp"

namespace diaphane::render {

double VertexLight::power(const geometry::PlacedShape& shape) const {
  double sum = 0;
  for (size_t t = 0; t < topology_->triangles.size(); ++t) {
    const glm::uvec3& i = topology_->triangles[t];
    const glm::vec3& a = shape.positions_mm[i.x];
    const glm::vec3 doubled_area = glm::cross(shape.positions_mm[i.y] - a, shape.positions_mm[i.z] - a);
    const glm::vec3& e = stage_.result().of_triangle[t];
    sum += 0.5 * glm::length(doubled_area) * (e.r + e.g + e.b);
  }
  return sum;
}

void VertexLight::update(const std::shared_ptr<const geometry::MeshTopology>& topology, const Inputs& inputs,
                         StageClock& clock) {
  if (topology_ == nullptr || topology_->mesh != topology) {
    clock.run("order", [&] { topology_ = diffusion::build_surface_topology(topology); });
    reads_.forget();
  } else {
    clock.sleep("order");
  }
  std::vector<LightStorage> lights(inputs.lights.begin(), inputs.lights.end());
  if (!reads_.renew({inputs.shape_generation, lights, inputs.refractive_index, inputs.shadows_generation})) {
    clock.sleep("irradiance");
    return;
  }
  clock.run("irradiance", [&] {
    lights_ = std::move(lights);
    irradiance_.assign(inputs.shape.positions_mm.size(), glm::vec3(0));
    for (size_t i = 0; i < lights_.size(); ++i) {
      const std::span<const LightStorage> light = inputs.lights.subspan(i, 1);
      stage_.run(*topology_, inputs.shape, light, inputs.refractive_index, nullptr);
      const double unshadowed = power(inputs.shape);
      stage_.run(*topology_, inputs.shape, light, inputs.refractive_index, &inputs.shadows);
      const double shadowed = power(inputs.shape);
      // A light that shines on no outside, within the body for one, has nothing to lose.
      lights_[i].shape.z = unshadowed > 0 ? static_cast<float>(std::min(shadowed / unshadowed, 1.0)) : 1.0f;
      for (size_t v = 0; v < irradiance_.size(); ++v) irradiance_[v] += stage_.result().of_vertex[v];
    }
    ++generation_;
  });
}

size_t VertexLight::bytes() const {
  if (topology_ == nullptr) return 0;
  constexpr size_t kPerTriangle = sizeof(glm::uvec3) + 3 * sizeof(uint32_t) + 3 * sizeof(glm::vec3);
  constexpr size_t kPerVertex = 4 * sizeof(uint32_t) + 2 * sizeof(glm::vec3);
  return topology_->triangles.size() * kPerTriangle + irradiance_.size() * kPerVertex;
}

}  // namespace diaphane::render

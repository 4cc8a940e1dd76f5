#include "render/vertex_light.h"

#include <utility>

#include "glm/geometric.hpp"
#include "render/lights.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

/// A third of each triangle for each of its vertices.
void fill_vertex_areas(const geometry::MeshTopology& topology, const geometry::PlacedShape& shape,
                       std::vector<float>& areas_mm2) {
  areas_mm2.assign(shape.positions_mm.size(), 0.0f);
  for (const glm::uvec3& t : topology.triangles) {
    const glm::vec3& a = shape.positions_mm[t.x];
    const float third = glm::length(glm::cross(shape.positions_mm[t.y] - a, shape.positions_mm[t.z] - a)) / 6;
    for (const uint32_t v : {t.x, t.y, t.z}) areas_mm2[v] += third;
  }
}

double sum(const glm::vec3& rgb) { return static_cast<double>(rgb.r) + rgb.g + rgb.b; }

}  // namespace

float VertexLight::add(const LightStorage& light, const Inputs& inputs) {
  arrivals_.resize(irradiance_.size());
  tbb::parallel_for(size_t{0}, arrivals_.size(), [&](size_t v) {
    const glm::vec3& point_mm = inputs.shape.positions_mm[v];
    const glm::vec3& normal = inputs.shape.normals[v];
    const glm::vec3 entering = entering_irradiance(light, point_mm, normal, inputs.refractive_index);
    // What looks away needs no ray.
    const bool faces = entering != glm::vec3(0);
    const bool asks = faces && inputs.shadows != nullptr;
    arrivals_[v] = {entering, asks ? inputs.shadows->visibility_at(light, point_mm, normal) : faces ? 1.0f : 0.0f};
  });
  double unshadowed_w = 0;
  double shadowed_w = 0;
  for (size_t v = 0; v < arrivals_.size(); ++v) {
    const auto& [entering, seen] = arrivals_[v];
    irradiance_[v] += seen * entering;
    const double power_w = areas_mm2_[v] * sum(entering);
    unshadowed_w += power_w;
    shadowed_w += seen * power_w;
  }
  // A light that shines on no outside, one within the body for example, has nothing to lose.
  return unshadowed_w > 0 ? static_cast<float>(shadowed_w / unshadowed_w) : 1.0f;
}

void VertexLight::occlude(const Inputs& inputs) {
  const std::vector<glm::uvec3>& triangles = inputs.topology.triangles;
  occlusion_.look(triangles, inputs.shape, *inputs.occluders);
  occlusion_.weigh(triangles, inputs.shape, inputs.ambient, inputs.refractive_index);
  const size_t count = irradiance_.size();
  const float* shares = occlusion_.of_vertices();
  for (size_t v = 0; v < count; ++v) {
    irradiance_[v] *= glm::vec3(shares[v], shares[count + v], shares[2 * count + v]);
  }
}

void VertexLight::update(const Inputs& inputs, StageClock& clock) {
  std::get<0>(key_) = inputs.generation;
  std::get<1>(key_).assign(inputs.lights.begin(), inputs.lights.end());
  std::get<2>(key_) = inputs.ambient;
  std::get<3>(key_) = inputs.refractive_index;
  std::get<4>(key_) = inputs.shadows_generation;
  if (!reads_.renew(key_)) {
    clock.sleep("irradiance");
    return;
  }
  clock.run("irradiance", [&] {
    lights_ = std::get<1>(key_);
    if (inputs.shadows != nullptr) inputs.shadows->prepare_rays();
    irradiance_.assign(inputs.shape.positions_mm.size(), glm::vec3(0));
    if (inputs.ambient.light != nullptr) {
      const AmbientIrradiance around = ambient_irradiance(inputs.ambient, inputs.refractive_index);
      tbb::parallel_for(size_t{0}, irradiance_.size(),
                        [&](size_t v) { irradiance_[v] = around.at(inputs.shape.normals[v]); });
      if (inputs.occluders != nullptr) occlude(inputs);
    }
    fill_vertex_areas(inputs.topology, inputs.shape, areas_mm2_);
    for (LightStorage& light : lights_) light.shape.z = add(light, inputs);
    ++generation_;
  });
}

}  // namespace diaphane::render

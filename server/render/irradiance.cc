#include "render/irradiance.h"

#include <algorithm>

#include "glm/geometric.hpp"
#include "render/lights.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

template <typename Work>
void for_each(size_t count, Work&& work) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1024), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

}  // namespace

void IrradianceStage::cast_shadows(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
                                   std::span<const LightStorage> lights, const ShadowScene& shadows) {
  const size_t triangles = topology.triangles.size();
  centroids_mm_.resize(triangles);
  facet_normals_.resize(triangles);
  areas_.resize(triangles);
  of_triangle_.resize(lights.size() * triangles);
  of_slot_.resize(lights.size() * topology.slot_count);
  for_each(triangles, [&](size_t t) {
    const glm::uvec3& i = topology.triangles[t];
    const glm::vec3& a = shape.positions_mm[i.x];
    const glm::vec3& b = shape.positions_mm[i.y];
    const glm::vec3& c = shape.positions_mm[i.z];
    centroids_mm_[t] = (a + b + c) / 3.0f;
    const glm::vec3 doubled_area = glm::cross(b - a, c - a) * (shape.flipped ? -1.0f : 1.0f);
    areas_[t] = glm::length(doubled_area);
    facet_normals_[t] = areas_[t] > 0 ? doubled_area / areas_[t] : glm::vec3(0);
  });
  for (size_t light = 0; light < lights.size(); ++light) {
    const std::span<float> seen(of_triangle_.data() + light * triangles, triangles);
    shadows.visibility(lights[light], centroids_mm_, facet_normals_, seen);
    float* of_slot = of_slot_.data() + light * topology.slot_count;
    for_each(topology.slot_count, [&](size_t w) {
      float sum = 0;
      float area = 0;
      for (uint32_t k = topology.first_corner[w]; k < topology.first_corner[w + 1]; ++k) {
        const uint32_t t = topology.triangle_of_corner[k];
        sum += areas_[t] * seen[t];
        area += areas_[t];
      }
      of_slot[w] = area > 0 ? sum / area : 1.0f;
    });
  }
}

void IrradianceStage::run(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
                          std::span<const LightStorage> lights, float refractive_index, const ShadowScene* shadows) {
  const size_t triangles = topology.triangles.size();
  irradiance_.of_triangle.resize(triangles);
  irradiance_.of_vertex.resize(shape.positions_mm.size());
  if (shadows != nullptr) cast_shadows(topology, shape, lights, *shadows);
  for_each(triangles, [&](size_t t) {
    const glm::uvec3& i = topology.triangles[t];
    const glm::vec3 centroid = (shape.positions_mm[i.x] + shape.positions_mm[i.y] + shape.positions_mm[i.z]) / 3.0f;
    const glm::vec3 sum = shape.normals[i.x] + shape.normals[i.y] + shape.normals[i.z];
    const float length = glm::length(sum);
    const glm::vec3 normal = length > 0 ? sum / length : shape.normals[i.x];
    glm::vec3 e(0);
    for (size_t light = 0; light < lights.size(); ++light) {
      const float seen = shadows == nullptr ? 1.0f : of_triangle_[light * triangles + t];
      if (seen > 0) e += seen * entering_irradiance(lights[light], centroid, normal, refractive_index);
    }
    irradiance_.of_triangle[t] = e;
  });
  for_each(shape.positions_mm.size(), [&](size_t v) {
    glm::vec3 e(0);
    for (size_t light = 0; light < lights.size(); ++light) {
      const float seen = shadows == nullptr ? 1.0f : of_slot_[light * topology.slot_count + topology.slot_of_vertex[v]];
      if (seen > 0) {
        e += seen * entering_irradiance(lights[light], shape.positions_mm[v], shape.normals[v], refractive_index);
      }
    }
    irradiance_.of_vertex[v] = e;
  });
}

}  // namespace diaphane::render

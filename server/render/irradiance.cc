#include "render/irradiance.h"

#include <algorithm>
#include <cmath>

#include "glm/geometric.hpp"
#include "render/entering_light.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kChunk = SurfacePoints::kCapacity;
// What a vector may read behind the last value.
constexpr size_t kPadding = 16;

/// Calls work(i) for i below `count`, spread over all cores.
template <typename Work>
void for_each(size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1024), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

/// E at `irradiance.size()` points, which `place(points, i, index)` puts into lane i. `seen`, where not null, has a row
/// of that many values for each light.
template <typename Place>
void light_points(std::span<const LightStorage> lights, float refractive_index, const float* seen,
                  std::span<glm::vec3> irradiance, const Place& place) {
  const size_t count = irradiance.size();
  tbb::parallel_for(size_t{0}, (count + kChunk - 1) / kChunk, [&](size_t chunk) {
    const size_t first = chunk * kChunk, in_chunk = std::min(kChunk, count - first);
    SurfacePoints points;
    EnteringLight sum{};
    for (size_t i = 0; i < in_chunk; ++i) place(points, i, first + i);
    // Lanes behind the last repeat it.
    for (size_t i = in_chunk; i % kPadding != 0; ++i) place(points, i, first + in_chunk - 1);
    for (size_t light = 0; light < lights.size(); ++light) {
      add_entering_light(lights[light], refractive_index, points, in_chunk,
                         seen == nullptr ? nullptr : seen + light * count + first, sum);
    }
    for (size_t i = 0; i < in_chunk; ++i) {
      irradiance[first + i] = {sum.channel[0][i], sum.channel[1][i], sum.channel[2][i]};
    }
  });
}

}  // namespace

void IrradianceStage::cast_shadows(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
                                   std::span<const LightStorage> lights, ShadowScene& shadows) {
  const size_t triangles = topology.triangles.size(), vertices = shape.positions_mm.size();
  of_triangle_.resize(lights.size() * triangles + kPadding);
  of_vertex_.resize(lights.size() * vertices + kPadding);
  for (size_t light = 0; light < lights.size(); ++light) {
    const std::span<float> seen(of_triangle_.data() + light * triangles, triangles);
    shadows.visibility(lights[light], topology.triangles, shape, seen);
    float* of_vertex = of_vertex_.data() + light * vertices;
    for_each(vertices, [&](size_t v) {
      const uint32_t slot = topology.slot_of_vertex[v];
      const uint32_t begin = topology.first_corner[slot], end = topology.first_corner[slot + 1];
      float sum = 0;
      for (uint32_t k = begin; k < end; ++k) sum += seen[topology.triangle_of_corner[k]];
      of_vertex[v] = begin < end ? sum / static_cast<float>(end - begin) : 1.0f;
    });
  }
}

void IrradianceStage::run(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape,
                          std::span<const LightStorage> lights, float refractive_index, ShadowScene* shadows) {
  irradiance_.of_triangle.resize(topology.triangles.size());
  irradiance_.of_vertex.resize(shape.positions_mm.size());
  if (shadows != nullptr) cast_shadows(topology, shape, lights, *shadows);
  light_points(lights, refractive_index, shadows == nullptr ? nullptr : of_triangle_.data(), irradiance_.of_triangle,
               [&](SurfacePoints& points, size_t lane, size_t t) {
                 const glm::uvec3& i = topology.triangles[t];
                 const glm::vec3 sum = shape.normals[i.x] + shape.normals[i.y] + shape.normals[i.z];
                 const float length2 = glm::dot(sum, sum);
                 points.set(lane, (shape.positions_mm[i.x] + shape.positions_mm[i.y] + shape.positions_mm[i.z]) / 3.0f,
                            length2 > 0 ? sum / std::sqrt(length2) : shape.normals[i.x]);
               });
  light_points(
      lights, refractive_index, shadows == nullptr ? nullptr : of_vertex_.data(), irradiance_.of_vertex,
      [&](SurfacePoints& points, size_t lane, size_t v) { points.set(lane, shape.positions_mm[v], shape.normals[v]); });
}

}  // namespace diaphane::render

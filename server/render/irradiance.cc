#include "render/irradiance.h"

#include <algorithm>

#include "diffusion/four.h"
#include "render/entering_light.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/irradiance.cc"
// foreach_target.h comes before whatever it repeats.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

// The vectors are four wide everywhere; the SIMD level says with which instructions.
HWY_BEFORE_NAMESPACE();
namespace diaphane::render::HWY_NAMESPACE {

using diffusion::Four, diffusion::load3, diffusion::load4;

constexpr size_t kPadding = SurfacePoints::kPadding;

/// Puts four points at `lane`; their normals, of any length, get length one. One without a direction takes
/// `fallback(its lane of the four)`.
template <typename Fallback>
HWY_INLINE void put_four(Four (&positions_mm)[4], Four (&normals)[4], size_t lane, const Fallback& fallback,
                         SurfacePoints& points) {
  diffusion::transpose4(positions_mm[0], positions_mm[1], positions_mm[2], positions_mm[3]);
  diffusion::transpose4(normals[0], normals[1], normals[2], normals[3]);
  const Four zero{};
  Four length2 = normals[0] * normals[0] + normals[1] * normals[1] + normals[2] * normals[2];
  const uint32_t without = ~diffusion::bits_of(length2 > zero) & 15u;
  for (uint32_t k = 0; without != 0 && k < 4; ++k) {
    if ((without >> k & 1) == 0) continue;
    const glm::vec3 normal = fallback(k);
    for (int a = 0; a < 3; ++a) normals[a][k] = normal[a];
    length2[k] = 1;
  }
  const Four inverse = 1.0f / diffusion::sqrt4(length2);
  float* const positions_to[] = {points.x, points.y, points.z};
  float* const normals_to[] = {points.normal_x, points.normal_y, points.normal_z};
  for (int a = 0; a < 3; ++a) {
    diffusion::store4(positions_to[a] + lane, positions_mm[a]);
    diffusion::store4(normals_to[a] + lane, normals[a] * inverse);
  }
}

/// The centroids of triangles first, first + 1, ..., `count` in all; the last one is repeated up to kPadding.
void place_triangles(const diffusion::SurfaceTopology& topology, const geometry::PlacedShape& shape, size_t first,
                     size_t count, SurfacePoints& points) {
  for (size_t lane = 0; lane < (count + kPadding - 1) / kPadding * kPadding; lane += 4) {
    const glm::uvec3* corners[4];
    Four positions[4], normals[4];
    for (size_t k = 0; k < 4; ++k) {
      corners[k] = &topology.triangles[first + std::min(lane + k, count - 1)];
      const auto sum_of = [&](const std::vector<glm::vec3>& values) HWY_ATTR {
        return load3(&values[corners[k]->x].x) + load3(&values[corners[k]->y].x) + load3(&values[corners[k]->z].x);
      };
      positions[k] = sum_of(shape.positions_mm) * (1.0f / 3);
      normals[k] = sum_of(shape.normals);
    }
    put_four(
        positions, normals, lane, [&](uint32_t k) HWY_ATTR { return shape.normals[corners[k]->x]; }, points);
  }
}

/// Likewise for vertices.
void place_vertices(const geometry::PlacedShape& shape, size_t first, size_t count, SurfacePoints& points) {
  for (size_t lane = 0; lane < (count + kPadding - 1) / kPadding * kPadding; lane += 4) {
    Four positions[4], normals[4];
    for (size_t k = 0; k < 4; ++k) {
      const size_t v = first + std::min(lane + k, count - 1);
      positions[k] = load3(&shape.positions_mm[v].x);
      normals[k] = load3(&shape.normals[v].x);
    }
    put_four(
        positions, normals, lane, [](uint32_t) { return glm::vec3(0, 0, 1); }, points);
  }
}

/// As AmbientIrradiance::at().
void add_ambient(const AmbientIrradiance& ambient, const SurfacePoints& points, size_t first, size_t count,
                 const Receivers& receivers, EnteringLight& sum) {
  for (size_t i = 0; i < count; i += 4) {
    const Four x = load4(points.normal_x + i), y = load4(points.normal_y + i), z = load4(points.normal_z + i);
    Four polynomials[optics::kHarmonics];
    optics::harmonic_polynomials<Four, float>(ambient.cosine * x - ambient.sine * z, y,
                                              ambient.sine * x + ambient.cosine * z, polynomials);
    for (int c = 0; c < 3; ++c) {
      Four e{};
      for (size_t k = 0; k < optics::kHarmonics; ++k) e += ambient.harmonics[k][c] * polynomials[k];
      if (receivers.open != nullptr) {
        e *= load4(receivers.open + static_cast<size_t>(c) * receivers.irradiance.size() + first + i);
      }
      diffusion::store4(sum.channel[c] + i, load4(sum.channel[c] + i) + diffusion::max4(e, Four{}));
    }
  }
}

/// E at the `count` points from `first` on.
void light_points(std::span<const LightStorage> lights, const AmbientIrradiance* ambient, float refractive_index,
                  const SurfacePoints& points, size_t first, size_t count, const Receivers& receivers) {
  EnteringLight sum{};
  if (ambient != nullptr) add_ambient(*ambient, points, first, count, receivers, sum);
  for (size_t light = 0; light < lights.size(); ++light) {
    const float* seen =
        receivers.seen == nullptr ? nullptr : receivers.seen + light * receivers.irradiance.size() + first;
    add_entering_light(lights[light], refractive_index, points, count, seen, sum);
  }
  for (size_t i = 0; i < count; i += 4) {
    Four rows[4] = {load4(sum.channel[0] + i), load4(sum.channel[1] + i), load4(sum.channel[2] + i), Four{}};
    diffusion::transpose4(rows[0], rows[1], rows[2], rows[3]);
    for (size_t k = 0; k < 4 && i + k < count; ++k) diffusion::store3(&receivers.irradiance[first + i + k].x, rows[k]);
  }
}

void light_triangles(const LitSurface& surface, size_t first, size_t count, const Receivers& receivers) {
  SurfacePoints points;
  place_triangles(surface.topology, surface.shape, first, count, points);
  light_points(surface.lights, surface.ambient, surface.refractive_index, points, first, count, receivers);
}

void light_vertices(const LitSurface& surface, size_t first, size_t count, const Receivers& receivers) {
  SurfacePoints points;
  place_vertices(surface.shape, first, count, points);
  light_points(surface.lights, surface.ambient, surface.refractive_index, points, first, count, receivers);
}

}  // namespace diaphane::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diaphane::render {
HWY_EXPORT(light_triangles);
HWY_EXPORT(light_vertices);

namespace {

constexpr size_t kChunk = SurfacePoints::kCapacity;
constexpr size_t kPadding = SurfacePoints::kPadding;

/// Calls work(i) for i below `count`, spread over all cores.
template <typename Work>
void for_each(size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1024), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
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
                          std::span<const LightStorage> lights, const Ambient& ambient, float refractive_index,
                          ShadowScene* shadows, const AmbientOcclusion* occlusion) {
  irradiance_.of_triangle.resize(topology.triangles.size());
  irradiance_.of_vertex.resize(shape.positions_mm.size());
  if (shadows != nullptr) cast_shadows(topology, shape, lights, *shadows);
  const AmbientIrradiance around = ambient_irradiance(ambient, refractive_index);
  const LitSurface surface{topology, shape, lights, ambient.light == nullptr ? nullptr : &around, refractive_index};
  const Receivers triangles{irradiance_.of_triangle, shadows == nullptr ? nullptr : of_triangle_.data(),
                            occlusion == nullptr ? nullptr : occlusion->of_triangles()};
  const Receivers vertices{irradiance_.of_vertex, shadows == nullptr ? nullptr : of_vertex_.data(),
                           occlusion == nullptr ? nullptr : occlusion->of_vertices()};
  const size_t triangle_count = triangles.irradiance.size(), vertex_count = vertices.irradiance.size();
  const size_t triangle_chunks = (triangle_count + kChunk - 1) / kChunk;
  const size_t vertex_chunks = (vertex_count + kChunk - 1) / kChunk;
  tbb::parallel_for(size_t{0}, triangle_chunks + vertex_chunks, [&](size_t chunk) {
    if (chunk < triangle_chunks) {
      const size_t first = chunk * kChunk, count = std::min(kChunk, triangle_count - first);
      HWY_DYNAMIC_DISPATCH(light_triangles)(surface, first, count, triangles);
    } else {
      const size_t first = (chunk - triangle_chunks) * kChunk, count = std::min(kChunk, vertex_count - first);
      HWY_DYNAMIC_DISPATCH(light_vertices)(surface, first, count, vertices);
    }
  });
}

}  // namespace diaphane::render
#endif

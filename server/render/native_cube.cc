#include "render/native_cube.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "glm/geometric.hpp"
#include "render/raster.h"
#include "render/raster_candidates.h"
#include "render/raster_triangles.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kChunk = 2048;
constexpr int kRowsAtOnce = 8;

int u_axis(int axis) { return axis == 2 ? 0 : axis + 1; }
int v_axis(int axis) { return axis == 0 ? 2 : axis - 1; }

}  // namespace

void NativeCube::snap(std::span<const glm::vec3> positions_mm) {
  vertices_.resize(positions_mm.size());
  const glm::vec3 scale = static_cast<float>(kSubpixels * size_px_) / glm::vec3(box_.extent_mm);
  const glm::vec3 low_mm = glm::vec3(box_.centre_mm) - 0.5f * glm::vec3(box_.extent_mm);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, positions_mm.size(), kChunk), [&](const auto& range) {
    for (size_t v = range.begin(); v != range.end(); ++v) {
      // Within the box, all are above 0.
      const glm::vec3 place = (positions_mm[v] - low_mm) * scale + 0.5f;
      for (int a = 0; a < 3; ++a) vertices_[v].of_axis[a] = static_cast<int32_t>(place[a]);
    }
  });
}

void NativeCube::see(const RasterMesh& mesh, size_t begin, size_t end) {
  const auto face_cells = static_cast<size_t>(size_px_) * static_cast<size_t>(size_px_);
  const auto whole = static_cast<float>(kSubpixels * size_px_);
  const int32_t* const places = vertices_[0].of_axis;
  uint32_t candidates[3][kChunk + 16];
  size_t counts[3];
  find_candidates_by_axis(mesh.triangles, begin, end, places, size_px_, {candidates[0], candidates[1], candidates[2]},
                          counts);
  // Counter-clockwise is the outside seen from above, along −axis.
  const bool outside = !mesh.facing_only || !mesh.flipped, inside = !mesh.facing_only || mesh.flipped;
  for (int axis = 0; axis < 3; ++axis) {
    uint64_t* const above = seen_.data() + static_cast<size_t>(2 * axis) * face_cells;
    draw_triangles(mesh.triangles, {candidates[axis], counts[axis]}, 0,
                   {places + u_axis(axis), places + v_axis(axis), size_px_, size_px_},
                   {.integer = places + axis, .whole = whole}, {above, outside, inside},
                   {above + face_cells, inside, outside});
  }
}

/// E of the points, and all else that their texels hold.
void NativeCube::store(const PointBatch& points, const RasterMesh& mesh, int face) {
  const int axis = face / 2;
  const float sign = face % 2 == 0 ? 1.0f : -1.0f;
  EnteringLight sum;
  if (mesh.values.empty()) {
    for (auto& channel : sum.channel) std::fill_n(channel, PointBatch::kCapacity, 0.0f);
    for (const LightStorage& light : key_.lights) {
      add_entering_light(light, key_.refractive_index, points.surface, points.count, nullptr, sum);
    }
  }
  const auto& entering = mesh.values.empty() ? sum.channel : points.value;
  const SurfacePoints& surface = points.surface;
  float* texels = texels_.data() +
                  static_cast<size_t>(kFloatsPerTexel) * static_cast<size_t>(face) * static_cast<size_t>(face_texels());
  for (size_t i = 0; i < points.count; ++i) {
    glm::vec3 n(surface.normal_x[i], surface.normal_y[i], surface.normal_z[i]);
    const glm::vec3 from_centre = glm::vec3(surface.x[i], surface.y[i], surface.z[i]) - glm::vec3(box_.centre_mm);
    // Only the size of N along the face is told by u and v: the stored normal looks at the face.
    if (n[axis] * sign < 0) n = -n;
    const float texel[] = {entering[0][i],  entering[1][i],  entering[2][i],    glm::dot(n, from_centre),
                           n[u_axis(axis)], n[v_axis(axis)], from_centre[axis], 1};
    std::memcpy(texels + static_cast<size_t>(kFloatsPerTexel) * points.cell[i], texel, sizeof texel);
  }
}

void NativeCube::fill_rows(const RasterMesh& mesh, int face, int begin, int end) {
  const auto size = static_cast<size_t>(size_px_);
  const int axis = face / 2, u = u_axis(axis), v = v_axis(axis);
  const glm::vec3 low_mm = glm::vec3(box_.centre_mm) - 0.5f * glm::vec3(box_.extent_mm);
  const float u_texel_mm = box_.extent_mm[u] / static_cast<float>(size_px_);
  const float v_texel_mm = box_.extent_mm[v] / static_cast<float>(size_px_);
  PointBatch points;
  const auto flush = [&] {
    if (points.count == 0) return;
    find_face_points(mesh, axis, points);
    store(points, mesh, face);
    points.count = 0;
  };
  for (int y = begin; y < end; ++y) {
    const uint64_t* row = seen_.data() + (static_cast<size_t>(face) * size + static_cast<size_t>(y)) * size;
    const int first = (y + 1) * row_texels() + 1;
    float* texels = texels_.data() +
                    static_cast<size_t>(kFloatsPerTexel) *
                        (static_cast<size_t>(face) * static_cast<size_t>(face_texels()) + static_cast<size_t>(first));
    for (int x = 0; x < size_px_; ++x) {
      if (row[x] == 0) {
        std::fill_n(texels + kFloatsPerTexel * x, kFloatsPerTexel, 0.0f);
        continue;
      }
      const size_t i = points.count++;
      points.cell[i] = static_cast<uint32_t>(first + x);
      points.triangle[i] = triangle_of_key(row[x]);
      points.x[i] = low_mm[u] + (static_cast<float>(x) + 0.5f) * u_texel_mm;
      points.y[i] = low_mm[v] + (static_cast<float>(y) + 0.5f) * v_texel_mm;
      if (points.count == PointBatch::kCapacity) flush();
    }
  }
  flush();
}

void NativeCube::draw(const AtlasKey& key, const BoxUniforms& box, const RasterMesh& mesh) {
  key_ = key;
  box_ = box;
  if (size_px_ != box.face_size_px) {
    size_px_ = box.face_size_px;
    texels_.assign(static_cast<size_t>(kFloatsPerTexel * kFaces) * static_cast<size_t>(face_texels()), 0.0f);
  }
  seen_.assign(static_cast<size_t>(kFaces) * static_cast<size_t>(size_px_) * static_cast<size_t>(size_px_), 0);
  snap(mesh.positions_mm);
  const size_t triangles = mesh.triangles.size();
  tbb::parallel_for(size_t{0}, (triangles + kChunk - 1) / kChunk, [&](size_t chunk) {
    const size_t begin = chunk * kChunk, end = std::min(begin + kChunk, triangles);
    see(mesh, begin, end);
  });
  const int bands = (size_px_ + kRowsAtOnce - 1) / kRowsAtOnce;
  tbb::parallel_for(0, kFaces * bands, [&](int job) {
    const int begin = job % bands * kRowsAtOnce;
    fill_rows(mesh, job / bands, begin, std::min(begin + kRowsAtOnce, size_px_));
  });
}

}  // namespace diaphane::render

#include "render/native_view.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "glm/vec4.hpp"
#include "render/raster_candidates.h"
#include "render/raster_triangles.h"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kChunk = 2048;
constexpr uint32_t kRowsAtOnce = 8;
// Corners beyond so many half pictures are clipped, so that their places and the products of sides stay whole numbers.
constexpr float kGuard = 8;

bool is_safe(const glm::vec4& clip) {
  return clip.z >= -clip.w && std::abs(clip.x) <= kGuard * clip.w && std::abs(clip.y) <= kGuard * clip.w;
}

/// How far inside one of five planes a corner is; below 0 outside.
float inside(int plane, const glm::vec4& clip) {
  switch (plane) {
    case 0:
      return clip.z + clip.w;
    case 1:
      return kGuard * clip.w - clip.x;
    case 2:
      return kGuard * clip.w + clip.x;
    case 3:
      return kGuard * clip.w - clip.y;
    default:
      return kGuard * clip.w + clip.y;
  }
}

/// A triangle cut by five planes (Sutherland and Hodgman 1974).
struct Polygon {
  std::array<glm::vec4, 16> corners;  // 8 but for rounding
  size_t count = 0;

  void add(const glm::vec4& corner) {
    if (count < corners.size()) corners[count++] = corner;
  }

  void cut(int plane) {
    const Polygon whole = *this;
    count = 0;
    for (size_t i = 0; i < whole.count; ++i) {
      const glm::vec4& from = whole.corners[i];
      const glm::vec4& to = whole.corners[(i + 1) % whole.count];
      const float at_from = inside(plane, from), at_to = inside(plane, to);
      if (at_from >= 0) add(from);
      if ((at_from >= 0) != (at_to >= 0)) add(from + at_from / (at_from - at_to) * (to - from));
    }
  }
};

}  // namespace

NativeView::Corner NativeView::place(const glm::vec4& clip) const {
  const float inverse = 1 / clip.w;
  const auto raster = [&](float of_clip, uint32_t size_px, uint32_t first_px) {
    const float px = (0.5f * of_clip * inverse + 0.5f) * static_cast<float>(size_px) - static_cast<float>(first_px);
    return static_cast<int32_t>(std::floor(px * kSubpixels + 0.5f));
  };
  return {{raster(clip.x, picture_.width_px, tile_.x_px), raster(clip.y, picture_.height_px, tile_.y_px)}, inverse};
}

void NativeView::place_vertices(const RasterMesh& mesh) {
  std::atomic<bool> clips = false;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.positions_mm.size(), kChunk), [&](const auto& range) {
    bool all_safe = true;
    for (size_t v = range.begin(); v != range.end(); ++v) {
      const glm::vec4 clip = picture_.clip_from_world * glm::vec4(mesh.positions_mm[v], 1);
      const bool safe = is_safe(clip);
      all_safe &= safe;
      corners_[v] = safe ? place(clip) : Corner{{0, 0}, -1};
    }
    if (!all_safe) clips.store(true, std::memory_order_relaxed);
  });
  clips_ = clips.load();
}

void NativeView::see_triangle(const RasterMesh& mesh, const Corner& a, const Corner& b, const Corner& c,
                              uint32_t index) {
  const auto width = static_cast<int32_t>(tile_.width_px), height = static_cast<int32_t>(tile_.height_px);
  const RasterRange range = raster_range(a.at, b.at, c.at, width, height);
  if (range.x_begin >= range.x_end || range.y_begin >= range.y_end) return;
  const int64_t area = doubled_area(a.at, b.at, c.at);
  if (area == 0 || (mesh.facing_only && (area > 0) == mesh.flipped)) return;
  const Corner& left = area > 0 ? b : c;
  const Corner& right = area > 0 ? c : b;
  const float to_left = left.nearness - a.nearness, to_right = right.nearness - a.nearness;
  cover_any(a.at, left.at, right.at, std::abs(area), range, [&](int x, int y, float of_left, float of_right) {
    const float nearness = a.nearness + of_left * to_left + of_right * to_right;
    raise(seen_[static_cast<size_t>(y) * tile_.width_px + static_cast<size_t>(x)], visible_key(nearness, index));
  });
}

void NativeView::see_clipped(const RasterMesh& mesh, const glm::uvec3& triangle, uint32_t index) {
  Polygon polygon;
  for (int k = 0; k < 3; ++k) {
    polygon.add(picture_.clip_from_world * glm::vec4(mesh.positions_mm[triangle[k]], 1));
  }
  for (int plane = 0; plane < 5; ++plane) polygon.cut(plane);
  for (size_t k = 2; k < polygon.count; ++k) {
    see_triangle(mesh, place(polygon.corners[0]), place(polygon.corners[k - 1]), place(polygon.corners[k]), index);
  }
}

void NativeView::see(const RasterMesh& mesh, uint32_t first_triangle, size_t begin, size_t end) {
  const auto index_of = [&](size_t t) { return first_triangle + static_cast<uint32_t>(t); };
  const auto see_whole = [&](size_t t) {
    const glm::uvec3& triangle = mesh.triangles[t];
    see_triangle(mesh, corners_[triangle.x], corners_[triangle.y], corners_[triangle.z], index_of(t));
  };
  if (clips_) {
    for (size_t t = begin; t != end; ++t) {
      const glm::uvec3& i = mesh.triangles[t];
      const float least = std::min({corners_[i.x].nearness, corners_[i.y].nearness, corners_[i.z].nearness});
      least < 0 ? see_clipped(mesh, i, index_of(t)) : see_whole(t);
    }
    return;
  }
  uint32_t candidates[kChunk + 16];
  const Turn turn = !mesh.facing_only ? Turn::kEither : mesh.flipped ? Turn::kClockwise : Turn::kCounterClockwise;
  const CornerPlaces places{&corners_[0].at.x, &corners_[0].at.y, static_cast<int32_t>(tile_.width_px),
                            static_cast<int32_t>(tile_.height_px)};
  const size_t count = find_candidates(mesh.triangles, begin, end, places, turn, candidates);
  draw_triangles(mesh.triangles, {candidates, count}, first_triangle, places, {.real = &corners_[0].nearness},
                 {seen_.data(), turn != Turn::kClockwise, turn != Turn::kCounterClockwise}, {});
}

void NativeView::draw(const Picture& picture, const Tile& tile, std::span<const RasterMesh> meshes) {
  picture_ = picture;
  tile_ = tile;
  first_triangles_.assign(1, 0);
  size_t most_vertices = 0;
  for (const RasterMesh& mesh : meshes) {
    first_triangles_.push_back(first_triangles_.back() + static_cast<uint32_t>(mesh.triangles.size()));
    most_vertices = std::max(most_vertices, mesh.positions_mm.size());
  }
  corners_.resize(most_vertices);
  seen_.assign(size_t{tile.width_px} * tile.height_px, 0);
  for (size_t m = 0; m < meshes.size(); ++m) {
    place_vertices(meshes[m]);
    const size_t triangles = meshes[m].triangles.size();
    tbb::parallel_for(size_t{0}, (triangles + kChunk - 1) / kChunk, [&](size_t chunk) {
      const size_t begin = chunk * kChunk;
      see(meshes[m], first_triangles_[m], begin, std::min(begin + kChunk, triangles));
    });
  }
}

size_t NativeView::mesh_of(uint32_t triangle) const {
  const auto after = std::upper_bound(first_triangles_.begin(), first_triangles_.end(), triangle);
  return static_cast<size_t>(after - first_triangles_.begin()) - 1;
}

void NativeView::for_each_batch(std::span<const RasterMesh> meshes,
                                absl::FunctionRef<void(size_t mesh, const PointBatch& points)> shade) const {
  const uint32_t bands = (tile_.height_px + kRowsAtOnce - 1) / kRowsAtOnce;
  tbb::parallel_for(0u, bands, [&](uint32_t band) {
    PointBatch points;
    size_t mesh = 0;
    const auto flush = [&] {
      if (points.count == 0) return;
      find_view_points(meshes[mesh], picture_.clip_from_world, picture_.eye_mm, points);
      shade(mesh, points);
      points.count = 0;
    };
    const uint32_t y_end = std::min((band + 1) * kRowsAtOnce, tile_.height_px);
    for (uint32_t y = band * kRowsAtOnce; y < y_end; ++y) {
      const float clip_y = (2 * static_cast<float>(y + tile_.y_px) + 1) / static_cast<float>(picture_.height_px) - 1;
      for (uint32_t x = 0; x < tile_.width_px; ++x) {
        const size_t cell = size_t{y} * tile_.width_px + x;
        if (seen_[cell] == 0) continue;
        const uint32_t triangle = triangle_of_key(seen_[cell]);
        if (triangle < first_triangles_[mesh] || triangle >= first_triangles_[mesh + 1]) {
          flush();
          mesh = mesh_of(triangle);
        }
        const size_t i = points.count++;
        points.cell[i] = static_cast<uint32_t>(cell);
        points.triangle[i] = triangle - first_triangles_[mesh];
        points.x[i] = (2 * static_cast<float>(x + tile_.x_px) + 1) / static_cast<float>(picture_.width_px) - 1;
        points.y[i] = clip_y;
        if (points.count == PointBatch::kCapacity) flush();
      }
    }
    flush();
  });
}

}  // namespace diaphane::render

#include "render/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"
#include "tbb/parallel_reduce.h"

namespace diaphane::render {
namespace {

// A light nearer to the scene's centre than this many radii sees it at too wide an angle for one map.
constexpr float kNearestLight = 1.25f;
constexpr float kNothing = std::numeric_limits<float>::lowest();
constexpr size_t kChunk = 4096;

/// A texel or two for each vertex: E is not asked for more finely than that.
int size_for(size_t vertices) { return vertices < 60'000 ? 256 : vertices < 500'000 ? 512 : 1024; }

// Beyond this the cosine at which light enters is small enough for any error to drown.
constexpr float kSteepest = 8;

glm::vec3 centre_of(const geometry::Bounds& bounds) { return 0.5f * (bounds.lowest + bounds.highest); }

float radius_of(const geometry::Bounds& bounds) { return 0.5f * glm::distance(bounds.lowest, bounds.highest); }

float least(float a, float b, float c) { return std::min(std::min(a, b), c); }
float most(float a, float b, float c) { return std::max(std::max(a, b), c); }

}  // namespace

bool ShadowMap::serves(const LightStorage& light, const geometry::Bounds& bounds_mm) {
  if (light.power.a != 0) return true;
  return light.shape.y == 0 &&
         glm::distance(glm::vec3(light.position_mm), centre_of(bounds_mm)) > kNearestLight * radius_of(bounds_mm);
}

void ShadowMap::aim(const LightStorage& light, const geometry::Bounds& bounds_mm) {
  directional_ = light.power.a != 0;
  const glm::vec3 centre = centre_of(bounds_mm);
  // A directional light's eye only keeps numbers small.
  eye_mm_ = directional_ ? centre : glm::vec3(light.position_mm);
  ahead_ = directional_ ? -glm::vec3(light.position_mm) : glm::normalize(centre - eye_mm_);
  const glm::vec3 other = std::abs(ahead_.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  right_ = glm::normalize(glm::cross(other, ahead_));
  up_ = glm::cross(ahead_, right_);
}

ShadowMap::Projected ShadowMap::project(const glm::vec3& point_mm) const {
  const glm::vec3 way = point_mm - eye_mm_;
  const float depth = glm::dot(way, ahead_);
  if (directional_) return {glm::dot(way, right_), glm::dot(way, up_), -depth};
  const float inverse = 1 / depth;
  return {glm::dot(way, right_) * inverse, glm::dot(way, up_) * inverse, inverse};
}

void ShadowMap::fit(std::span<const ShadowCaster> casters) {
  struct Extent {
    glm::vec2 low{std::numeric_limits<float>::max()};
    glm::vec2 high{std::numeric_limits<float>::lowest()};
  };
  const auto merge = [](const Extent& a, const Extent& b) {
    return Extent{glm::min(a.low, b.low), glm::max(a.high, b.high)};
  };
  size_t count = 0;
  for (const ShadowCaster& caster : casters) count += caster.positions_mm.size();
  vertices_.resize(count);
  size_px_ = size_for(count);
  Extent all;
  size_t first = 0;
  for (const ShadowCaster& caster : casters) {
    const Extent extent = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, caster.positions_mm.size(), kChunk), Extent{},
        [&](const tbb::blocked_range<size_t>& range, Extent so_far) {
          for (size_t v = range.begin(); v != range.end(); ++v) {
            const Projected p = project(caster.positions_mm[v]);
            vertices_[first + v] = p;
            so_far = merge(so_far, {{p.x, p.y}, {p.x, p.y}});
          }
          return so_far;
        },
        merge);
    all = merge(all, extent);
    first += caster.positions_mm.size();
  }
  // A margin of two texels on each side for the comparison's neighbours.
  const auto inner = static_cast<float>(size_px_ - 4);
  texels_per_unit_ = inner / std::max({all.high.x - all.low.x, all.high.y - all.low.y, 1e-20f});
  unit_of_texel_ = 1 / texels_per_unit_;
  low_ = all.low - 2 * unit_of_texel_;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kChunk), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t v = range.begin(); v != range.end(); ++v) {
      vertices_[v].x = (vertices_[v].x - low_.x) * texels_per_unit_;
      vertices_[v].y = (vertices_[v].y - low_.y) * texels_per_unit_;
    }
  });
}

void ShadowMap::rasterise(const ShadowCaster& caster, std::span<const Projected> vertices, size_t begin, size_t end,
                          float* nearest) const {
  // Seen by the light, outward triangles run clockwise in (right, up): ahead is right × up.
  const float outward = caster.flipped ? 1.0f : -1.0f;
  for (size_t t = begin; t != end; ++t) {
    const glm::uvec3& i = caster.triangles[t];
    const Projected& a = vertices[i.x];
    const Projected& b = vertices[i.y];
    const Projected& c = vertices[i.z];
    const float abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
    const float area = abx * acy - aby * acx;
    if (area == 0 || (caster.encloses_volume && area * outward < 0)) continue;
    // Texels whose centres, at halves, lie within the bounds; the map's margin keeps all of them inside it.
    const int x_begin = static_cast<int>(least(a.x, b.x, c.x) + 0.5f);
    const int x_end = static_cast<int>(most(a.x, b.x, c.x) + 0.5f);
    const int y_begin = static_cast<int>(least(a.y, b.y, c.y) + 0.5f);
    const int y_end = static_cast<int>(most(a.y, b.y, c.y) + 0.5f);
    if (x_begin == x_end || y_begin == y_end) continue;
    const float inverse = 1 / area;
    const float du = acy * inverse, dv = -aby * inverse;
    const float to_b = b.nearness - a.nearness, to_c = c.nearness - a.nearness;
    const float nearest_corner = most(a.nearness, b.nearness, c.nearness);
    const float dx = static_cast<float>(x_begin) + 0.5f - a.x;
    for (int y = y_begin; y < y_end; ++y) {
      const float dy = static_cast<float>(y) + 0.5f - a.y;
      float u = (dx * acy - dy * acx) * inverse;
      float v = (abx * dy - aby * dx) * inverse;
      float* texels = nearest + static_cast<ptrdiff_t>(y) * size_px_;
      for (int x = x_begin; x < x_end; ++x, u += du, v += dv) {
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float here = std::min(a.nearness + u * to_b + v * to_c, nearest_corner);
        texels[x] = texels[x] < here ? here : texels[x];
      }
    }
  }
}

void ShadowMap::draw(const LightStorage& light, const geometry::Bounds& bounds_mm,
                     std::span<const ShadowCaster> casters) {
  aim(light, bounds_mm);
  fit(casters);
  const size_t texel_count = static_cast<size_t>(size_px_) * size_px_;
  for (std::vector<float>& map : maps_) map.assign(texel_count, kNothing);
  size_t first = 0;
  for (const ShadowCaster& caster : casters) {
    const std::span<const Projected> vertices(vertices_.data() + first, caster.positions_mm.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, caster.triangles.size(), kChunk),
                      [&](const tbb::blocked_range<size_t>& range) {
                        std::vector<float>& map = maps_.local();
                        if (map.empty()) map.assign(texel_count, kNothing);
                        rasterise(caster, vertices, range.begin(), range.end(), map.data());
                      });
    first += caster.positions_mm.size();
  }
  nearest_.resize(texel_count);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, texel_count, 16 * kChunk),
                    [&](const tbb::blocked_range<size_t>& range) {
                      std::fill(&nearest_[range.begin()], nearest_.data() + range.end(), kNothing);
                      for (const std::vector<float>& map : maps_) {
                        const float* from = map.data();
                        float* to = nearest_.data();
                        for (size_t i = range.begin(); i != range.end(); ++i) to[i] = to[i] < from[i] ? from[i] : to[i];
                      }
                    });
}

float ShadowMap::visibility_at(const glm::vec3& point_mm, const glm::vec3& across) const {
  const glm::vec3 from_eye = point_mm - eye_mm_;
  const glm::vec3& way = directional_ ? ahead_ : from_eye;
  const float facing = -glm::dot(across, way);
  if (!(facing > 0)) return 0;
  const float facing2 = facing * facing;
  const float tilt2 = glm::dot(way, way) * glm::dot(across, across) - facing2;
  const float slope = std::sqrt(std::clamp(tilt2 / facing2, 0.0f, kSteepest * kSteepest));
  const Projected p = project(point_mm);
  const float depth = glm::dot(from_eye, ahead_);
  const float texel_mm = (directional_ ? 1.0f : depth) * unit_of_texel_;
  const float biased_depth = depth - texel_mm * (0.5f + slope);
  const float nearness = directional_ ? -biased_depth : 1 / std::max(biased_depth, 1e-20f);
  // Texel centres lie at halves.
  const float largest = static_cast<float>(size_px_) - 1.001f;
  const float x = std::clamp((p.x - low_.x) * texels_per_unit_ - 0.5f, 0.0f, largest);
  const float y = std::clamp((p.y - low_.y) * texels_per_unit_ - 0.5f, 0.0f, largest);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float right = x - static_cast<float>(column), above = y - static_cast<float>(row);
  const float* texels = &nearest_[static_cast<size_t>(row) * size_px_ + static_cast<size_t>(column)];
  const auto seen = [&](int offset) { return texels[offset] <= nearness ? 1.0f : 0.0f; };
  const float low = seen(0) + right * (seen(1) - seen(0));
  const float high = seen(size_px_) + right * (seen(size_px_ + 1) - seen(size_px_));
  return low + above * (high - low);
}

}  // namespace diaphane::render

#include "render/coat_layer.h"

#include <algorithm>
#include <cmath>

#include "glm/geometric.hpp"
#include "glm/mat3x3.hpp"
#include "render/ambient.h"
#include "render/lights.h"
#include "render/sample_pattern.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kAngles = 64;
constexpr float kMirror = 0.002f;    // GGX α up to which one draw is enough
constexpr float kWidening = 4;       // of the solid angle of one of many draws: else their pattern shows
constexpr size_t kMostTables = 256;  // kept between frames
constexpr float kGrazing = 1e-3f;    // least cosine to the eye: silhouettes' normals look away from it

/// Axes with z along the normal.
class Frame3 {
 public:
  explicit Frame3(const glm::vec3& normal) : z_(normal) {
    // Duff et al. 2017: no branch but the sign.
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
    x_ = {1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    y_ = {b, sign + normal.y * normal.y * a, -normal.y};
  }
  glm::vec3 to_local(const glm::vec3& v) const { return {glm::dot(v, x_), glm::dot(v, y_), glm::dot(v, z_)}; }
  glm::mat3 world_from_local() const { return {x_, y_, z_}; }

 private:
  glm::vec3 x_, y_, z_;
};

/// One point of a coat, and its light.
struct CoatPoint {
  const CoatTable& table;
  const CoatLight& light;
  const MapPyramid* pyramid;
  glm::vec3 position_mm, normal;
  Frame3 frame;
  glm::mat3 map_from_local;
  glm::vec3 to_eye;  ///< z along the normal

  glm::vec3 of_lights() const {
    glm::vec3 sum(0);
    for (const LightStorage& of : light.lights) {
      const ArrivingLight arriving = arriving_light(of, position_mm);
      const glm::vec3 to_light = frame.to_local(arriving.towards);
      const float reflected = table.coat().reflectance(to_light, to_eye) * std::max(to_light.z, 0.0f);
      if (!(reflected > 0)) continue;
      const float seen = light.shadows == nullptr ? 1.0f : light.shadows->visibility_at(of, position_mm, normal);
      sum += seen * reflected * arriving.irradiance;
    }
    return sum;
  }

  glm::vec3 from(const glm::vec3& direction, float solid_angle_sr) const {
    return pyramid->around(*light.environment->map, map_from_local * direction, solid_angle_sr);
  }

  /// Weighed so that even light gives R(μ) to the last digit.
  glm::vec3 of_environment() const {
    if (pyramid == nullptr) return glm::vec3(0);
    const float reflected = light.environment->intensity * table.coat().albedo(to_eye.z);
    if (table.coat().alpha() <= kMirror) return reflected * from({-to_eye.x, -to_eye.y, to_eye.z}, 0);
    const float length = std::hypot(to_eye.x, to_eye.y);
    const glm::vec2 along = length > 0 ? glm::vec2(to_eye) / length : glm::vec2(1, 0);
    glm::vec3 sum(0);
    float weights = 0;
    for (uint32_t i = 0; i < CoatTable::kDraws; ++i) {
      const CoatTable::Look look = table.look(to_eye.z, i);
      if (!(look.weight > 0)) continue;
      const glm::vec3& d = look.direction;
      const glm::vec3 turned(d.x * along.x - d.y * along.y, d.x * along.y + d.y * along.x, d.z);
      sum += look.weight * from(glm::normalize(turned), look.solid_angle_sr);
      weights += look.weight;
    }
    return weights > 0 ? reflected / weights * sum : glm::vec3(0);
  }
};

uint32_t roughness_step(const ChannelTile& tile, size_t pixel) {
  if (tile.coat.empty()) return kRoughnessSteps;
  return static_cast<uint32_t>(std::lround(std::clamp(tile.coat[pixel].w, 0.0f, 1.0f) * float{kRoughnessSteps}));
}

/// The coat's own where the tile is textured.
glm::vec3 coat_normal(const ChannelTile& tile, size_t pixel) {
  return tile.coat.empty() ? glm::vec3(tile.normal[pixel]) : glm::normalize(glm::vec3(tile.coat[pixel]));
}

}  // namespace

CoatTable::CoatTable(const optics::Coat& coat, float refractive_index) : coat_(coat, refractive_index) {
  looks_.reserve(kAngles * kDraws);
  for (size_t angle = 0; angle < kAngles; ++angle) {
    const float root = (static_cast<float>(angle) + 0.5f) / static_cast<float>(kAngles);
    const float cosine = root * root;
    const glm::vec3 to_eye(std::sqrt(1 - cosine * cosine), 0, cosine);
    for (uint32_t i = 0; i < kDraws; ++i) {
      const optics::BalancedCoat::Arrival drawn = coat_.arrival(to_eye, sample_place(i, kDraws));
      const float solid_angle_sr = drawn.weight > 0 ? kWidening / (static_cast<float>(kDraws) * drawn.density) : 0;
      looks_.push_back({drawn.direction, drawn.weight, solid_angle_sr});
    }
  }
}

CoatTable::Look CoatTable::look(float cosine, uint32_t draw) const {
  const float at = std::sqrt(cosine) * static_cast<float>(kAngles) - 0.5f;
  const float below = std::clamp(std::floor(at), 0.0f, static_cast<float>(kAngles - 2));
  const Look& a = looks_[static_cast<size_t>(below) * kDraws + draw];
  const Look& b = looks_[(static_cast<size_t>(below) + 1) * kDraws + draw];
  // One that comes from below at one of the angles fades out, and says nothing of its direction.
  const float share = std::clamp(at - below, 0.0f, 1.0f);
  if (!(a.weight > 0)) return {b.direction, b.weight * share, b.solid_angle_sr};
  if (!(b.weight > 0)) return {a.direction, a.weight * (1 - share), a.solid_angle_sr};
  return {glm::mix(a.direction, b.direction, share), glm::mix(a.weight, b.weight, share),
          glm::mix(a.solid_angle_sr, b.solid_angle_sr, share)};
}

const CoatTable& CoatLayer::table_of(const optics::Coat& coat, float refractive_index) {
  const std::pair<float, float> key(coat.roughness, refractive_index);
  const auto found = tables_.find(key);
  if (found != tables_.end()) return found->second;
  return tables_.emplace(key, CoatTable(coat, refractive_index)).first->second;
}

CoatLayer::TableSteps CoatLayer::tables_of(const optics::Coat& coat, float refractive_index, float mesh_id,
                                           const ChannelTile& tile) {
  if (tables_.size() + kRoughnessSteps + 1 > kMostTables) tables_.clear();
  TableSteps tables{};
  if (tile.coat.empty()) {
    tables[kRoughnessSteps] = &table_of(coat, refractive_index);
    return tables;
  }
  for (size_t p = 0; p < tile.coat.size(); ++p) {
    const CoatTable*& table = tables[roughness_step(tile, p)];
    if (table != nullptr || tile.position_mm[p].w != mesh_id) continue;
    const float share = static_cast<float>(roughness_step(tile, p)) / float{kRoughnessSteps};
    table = &table_of({.roughness = coat.roughness * share}, refractive_index);
  }
  return tables;
}

const MapPyramid* CoatLayer::pyramid(const CoatLight& light) {
  if (light.environment == nullptr) return nullptr;
  if (!pyramid_.has_value() || pyramid_of_.lock() != light.environment->map) {
    pyramid_.emplace(*light.environment->map);
    pyramid_of_ = light.environment->map;
  }
  return &*pyramid_;
}

void CoatLayer::forget_orphans() {
  if (pyramid_of_.expired()) pyramid_.reset();
}

void CoatLayer::add(const optics::Coat& coat, float refractive_index, float mesh_id, const CoatLight& light,
                    const glm::vec3& eye_mm, const ChannelTile& tile, std::span<glm::vec4> radiance) {
  const TableSteps tables = tables_of(coat, refractive_index, mesh_id, tile);
  const MapPyramid* coarser = pyramid(light);
  const float turn_deg = light.environment == nullptr ? 0 : -light.environment->rotation_deg;
  const glm::mat3 map_from_world(rotated_about_y({1, 0, 0}, turn_deg), glm::vec3(0, 1, 0),
                                 rotated_about_y({0, 0, 1}, turn_deg));
  tbb::parallel_for(tbb::blocked_range<size_t>(0, radiance.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t p = range.begin(); p != range.end(); ++p) {
      if (tile.position_mm[p].w != mesh_id) continue;
      const glm::vec3 position_mm(tile.position_mm[p]), normal = coat_normal(tile, p);
      // A vertex without area has no direction.
      if (!(glm::dot(normal, normal) > 0)) continue;
      const Frame3 frame(normal);
      glm::vec3 to_eye = frame.to_local(glm::normalize(eye_mm - position_mm));
      to_eye.z = std::max(to_eye.z, kGrazing);
      const CoatPoint point{*tables[roughness_step(tile, p)],
                            light,
                            coarser,
                            position_mm,
                            normal,
                            frame,
                            map_from_world * frame.world_from_local(),
                            glm::normalize(to_eye)};
      radiance[p] += glm::vec4(point.of_lights() + point.of_environment(), 0);
    }
  });
}

}  // namespace diaphane::render

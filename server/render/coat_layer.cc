#include "render/coat_layer.h"

#include <algorithm>
#include <cmath>

#include "glm/geometric.hpp"
#include "render/ambient.h"
#include "render/lights.h"
#include "render/sample_pattern.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr uint32_t kDraws = 32;
constexpr float kMirror = 0.002f;   // GGX α up to which one draw is enough
constexpr float kWidening = 4;      // of the solid angle of one of many draws: else their pattern shows
constexpr size_t kMostTables = 64;  // kept between frames
constexpr float kGrazing = 1e-3f;   // least cosine to the eye: silhouettes' normals look away from it

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
  glm::vec3 to_world(const glm::vec3& v) const { return v.x * x_ + v.y * y_ + v.z * z_; }

 private:
  glm::vec3 x_, y_, z_;
};

/// One point of a coat, and its light.
struct CoatPoint {
  const optics::BalancedCoat& coat;
  const CoatLight& light;
  const MapPyramid* pyramid;
  glm::vec3 position_mm, normal;
  Frame3 frame;
  glm::vec3 to_eye;  ///< z along the normal

  glm::vec3 of_lights() const {
    glm::vec3 sum(0);
    for (const LightStorage& of : light.lights) {
      const ArrivingLight arriving = arriving_light(of, position_mm);
      const glm::vec3 to_light = frame.to_local(arriving.towards);
      const float reflected = coat.reflectance(to_light, to_eye) * std::max(to_light.z, 0.0f);
      if (!(reflected > 0)) continue;
      const float seen = light.shadows == nullptr ? 1.0f : light.shadows->visibility_at(of, position_mm, normal);
      sum += seen * reflected * arriving.irradiance;
    }
    return sum;
  }

  /// Weighed so that even light gives R(μ) to the last digit.
  glm::vec3 of_environment() const {
    if (pyramid == nullptr) return glm::vec3(0);
    const uint32_t draws = coat.alpha() <= kMirror ? 1 : kDraws;
    const float widening = draws == 1 ? 1.0f : kWidening;
    glm::vec3 sum(0);
    float weights = 0;
    for (uint32_t i = 0; i < draws; ++i) {
      const optics::BalancedCoat::Arrival drawn =
          coat.arrival(to_eye, draws == 1 ? glm::vec2(0) : sample_place(i, draws));
      if (!(drawn.weight > 0)) continue;
      const glm::vec3 of_map = rotated_about_y(frame.to_world(drawn.direction), -light.environment->rotation_deg);
      sum += drawn.weight * pyramid->around(of_map, widening / (static_cast<float>(draws) * drawn.density));
      weights += drawn.weight;
    }
    if (!(weights > 0)) return glm::vec3(0);
    return light.environment->intensity * coat.albedo(to_eye.z) / weights * sum;
  }
};

}  // namespace

const optics::BalancedCoat& CoatLayer::balanced(const optics::Coat& coat, float refractive_index) {
  const std::pair<float, float> key(coat.roughness, refractive_index);
  const auto found = balanced_.find(key);
  if (found != balanced_.end()) return found->second;
  if (balanced_.size() >= kMostTables) balanced_.clear();
  return balanced_.emplace(key, optics::BalancedCoat(coat, refractive_index)).first->second;
}

const MapPyramid* CoatLayer::pyramid_of(const CoatLight& light) {
  if (light.environment == nullptr) {
    pyramid_.reset();
    return nullptr;
  }
  if (!pyramid_.has_value() || pyramid_->map() != light.environment->map) pyramid_.emplace(light.environment->map);
  return &*pyramid_;
}

void CoatLayer::add(const optics::Coat& coat, float refractive_index, float mesh_id, const CoatLight& light,
                    const glm::vec3& eye_mm, const ChannelTile& tile, std::span<glm::vec4> radiance) {
  const optics::BalancedCoat& table = balanced(coat, refractive_index);
  const MapPyramid* pyramid = pyramid_of(light);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, radiance.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t p = range.begin(); p != range.end(); ++p) {
      if (tile.position_mm[p].w != mesh_id) continue;
      const glm::vec3 position_mm(tile.position_mm[p]), normal(tile.normal[p]);
      const Frame3 frame(normal);
      glm::vec3 to_eye = frame.to_local(glm::normalize(eye_mm - position_mm));
      to_eye.z = std::max(to_eye.z, kGrazing);
      const CoatPoint point{table, light, pyramid, position_mm, normal, frame, glm::normalize(to_eye)};
      radiance[p] += glm::vec4(point.of_lights() + point.of_environment(), 0);
    }
  });
}

}  // namespace diaphane::render

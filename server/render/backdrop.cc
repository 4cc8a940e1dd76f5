#include "render/backdrop.h"

#include <cmath>

#include "glm/geometric.hpp"
#include "glm/trigonometric.hpp"
#include "render/ambient.h"
#include "render/sample_pattern.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

/// From a place in the picture to the direction that it looks in.
class Sight {
 public:
  Sight(const scene::Camera& camera, const base::ImageF& picture)
      : width_(static_cast<float>(picture.width_px)),
        height_(static_cast<float>(picture.height_px)),
        forward_(glm::normalize(camera.target - camera.eye)),
        right_(glm::normalize(glm::cross(forward_, camera.up))),
        up_(glm::cross(right_, forward_)),
        reach_(std::tan(0.5f * glm::radians(camera.fov_y_deg))) {}

  /// `x` from the left, `y` from the upper edge, pixels.
  glm::vec3 operator()(float x, float y) const {
    const float across = (2 * x - width_) / height_, upwards = 1 - 2 * y / height_;
    return glm::normalize(forward_ + reach_ * (across * right_ + upwards * up_));
  }

 private:
  float width_, height_;
  glm::vec3 forward_, right_, up_;
  float reach_;
};

glm::vec3 backdrop_radiance(const scene::Environment& environment, const glm::vec3& direction) {
  return environment.intensity *
         optics::radiance_towards(*environment.map, rotated_about_y(direction, -environment.rotation_deg));
}

}  // namespace

void lay_over_environment(const scene::Environment& environment, const scene::Camera& camera, uint32_t samples,
                          base::ImageF& picture) {
  const Sight sight(camera, picture);
  const size_t stride = picture.channels.size();
  tbb::parallel_for(uint32_t{0}, picture.height_px, [&](uint32_t y) {
    float* v = &picture.values[size_t{y} * picture.width_px * stride];
    for (uint32_t x = 0; x < picture.width_px; ++x, v += stride) {
      if (v[3] >= 1) continue;
      glm::vec3 seen(0);
      for (uint32_t i = 0; i < samples; ++i) {
        const glm::vec2 place = sample_place(i, samples);
        seen += backdrop_radiance(environment, sight(static_cast<float>(x) + place.x, static_cast<float>(y) + place.y));
      }
      seen *= (1 - v[3]) / static_cast<float>(samples);
      for (int c = 0; c < 3; ++c) v[c] += seen[c];
      v[3] = 1;
    }
  });
}

}  // namespace diaphane::render

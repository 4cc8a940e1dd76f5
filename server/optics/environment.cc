#include "optics/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEnough = 0.0085;            // of E: where taking out lamps ends
constexpr double kLeastShare = 0.0005;        // of the map's flux: less is no lamp
constexpr double kLamp_rad = 10 * kPi / 180;  // around the brightest place
constexpr double kRim_rad = 15 * kPi / 180;   // what lies between is the light around it
constexpr float kJudgedIndex = 1.5f;
constexpr uint32_t kJudgedHeight_px = 64, kSearchedHeight_px = 32;
constexpr size_t kJudgedNormals = 96;

double luminance(const glm::vec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

/// Means over blocks: at most `height_px` rows and twice as many columns, whatever the shape of `map`.
LatLongMap shrink(const LatLongMap& map, uint32_t height_px) {
  const auto divide_up = [](uint32_t of, uint32_t by) { return (of + by - 1) / by; };
  const uint32_t across = divide_up(map.width_px, 2 * height_px), down = divide_up(map.height_px, height_px);
  LatLongMap small{divide_up(map.width_px, across), divide_up(map.height_px, down), {}};
  small.radiance.resize(size_t{small.width_px} * small.height_px);
  std::vector<double> weights(down);
  for (uint32_t y = 0; y < small.height_px; ++y) {
    const uint32_t top = y * down, bottom = std::min(top + down, map.height_px);
    for (uint32_t v = top; v < bottom; ++v) weights[v - top] = map.solid_angle(v);
    for (uint32_t x = 0; x < small.width_px; ++x) {
      glm::dvec3 sum(0);
      double weight = 0;
      for (uint32_t v = top; v < bottom; ++v) {
        for (uint32_t u = x * across; u < std::min((x + 1) * across, map.width_px); ++u) {
          sum += weights[v - top] * glm::dvec3(map.radiance[size_t{v} * map.width_px + u]);
          weight += weights[v - top];
        }
      }
      small.radiance[size_t{y} * small.width_px + x] = glm::vec3(sum / weight);
    }
  }
  return small;
}

double flux(const LatLongMap& map) {
  double sum = 0;
  for (uint32_t y = 0; y < map.height_px; ++y) {
    const double solid_angle = map.solid_angle(y);
    for (uint32_t x = 0; x < map.width_px; ++x) {
      sum += solid_angle * luminance(map.radiance[size_t{y} * map.width_px + x]);
    }
  }
  return sum;
}

/// Calls visit(pixel, direction, solid angle) for what is within `angle_rad` of `axis`.
template <typename Visit>
void for_each_near(const LatLongMap& map, const glm::vec3& axis, double angle_rad, const Visit& visit) {
  const double cosine = std::cos(angle_rad);
  const double polar = std::acos(std::clamp(static_cast<double>(axis.y), -1.0, 1.0));
  const auto row = [&](double theta) { return theta / kPi * map.height_px; };
  const auto first = static_cast<uint32_t>(std::max(row(polar - angle_rad), 0.0));
  const auto last = static_cast<uint32_t>(std::min(row(polar + angle_rad) + 1, double{1} * map.height_px));
  for (uint32_t y = first; y < last; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const glm::vec3 direction = map.direction(x, y);
      if (glm::dot(direction, axis) >= cosine) visit(size_t{y} * map.width_px + x, direction, map.solid_angle(y));
    }
  }
}

/// The middle of the patch that is brightest as a whole.
glm::vec3 brightest(const LatLongMap& map) {
  glm::vec3 best(0, 1, 0);
  double most = -1;
  for (uint32_t y = 0; y < map.height_px; ++y) {
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const glm::vec3 axis = map.direction(x, y);
      double light = 0;
      for_each_near(map, axis, kLamp_rad, [&](size_t pixel, const glm::vec3&, double solid_angle) {
        light += solid_angle * luminance(map.radiance[pixel]);
      });
      if (light > most) most = light, best = axis;
    }
  }
  return best;
}

/// Cuts the patch around `axis` down to the mean light at its rim.
EnvironmentLamp cut_lamp(const glm::vec3& axis, LatLongMap& map) {
  glm::dvec3 rim(0);
  double rim_weight = 0;
  for_each_near(map, axis, kRim_rad, [&](size_t pixel, const glm::vec3& direction, double solid_angle) {
    if (glm::dot(direction, axis) >= std::cos(kLamp_rad)) return;
    rim += solid_angle * glm::dvec3(map.radiance[pixel]);
    rim_weight += solid_angle;
  });
  const glm::vec3 around = rim_weight > 0 ? glm::vec3(rim / rim_weight) : glm::vec3(0);
  glm::dvec3 irradiance(0), centre(0);
  for_each_near(map, axis, kLamp_rad, [&](size_t pixel, const glm::vec3& direction, double solid_angle) {
    const glm::vec3 above = glm::max(map.radiance[pixel] - around, glm::vec3(0));
    irradiance += solid_angle * glm::dvec3(above);
    centre += solid_angle * luminance(above) * glm::dvec3(direction);
    map.radiance[pixel] -= above;
  });
  const double length = glm::length(centre);
  return {length > 0 ? -glm::vec3(centre / length) : -axis, glm::vec3(irradiance)};
}

}  // namespace

glm::vec3 LatLongMap::direction(uint32_t x, uint32_t y) const {
  const double polar = kPi * (y + 0.5) / height_px;
  const double around = 2 * kPi * ((x + 0.5) / width_px - 0.5);
  return {static_cast<float>(std::sin(polar) * std::sin(around)), static_cast<float>(std::cos(polar)),
          static_cast<float>(-std::sin(polar) * std::cos(around))};
}

double LatLongMap::solid_angle(uint32_t y) const {
  return 2 * kPi / width_px * (std::cos(kPi * y / height_px) - std::cos(kPi * (y + 1.0) / height_px));
}

glm::vec3 radiance_towards(const LatLongMap& map, const glm::vec3& direction) {
  const float around = 0.5f + std::atan2(direction.x, -direction.z) / (2 * std::numbers::pi_v<float>);
  const float down = std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) / std::numbers::pi_v<float>;
  const float x = around * static_cast<float>(map.width_px) - 0.5f, y = down * static_cast<float>(map.height_px) - 0.5f;
  const float left = std::floor(x), above = std::floor(y);
  const auto width = static_cast<int32_t>(map.width_px), height = static_cast<int32_t>(map.height_px);
  // Both lie within the map or one beyond its edge.
  const auto column = static_cast<int32_t>(left), row = static_cast<int32_t>(above);
  const auto wrapped = [&](int32_t c) { return static_cast<size_t>(c < 0 ? c + width : c >= width ? c - width : c); };
  const size_t columns[] = {wrapped(column), wrapped(column + 1)};
  const auto along = [&](int32_t r) {
    const glm::vec3* of_row =
        map.radiance.data() + static_cast<size_t>(std::clamp(r, 0, height - 1)) * static_cast<size_t>(width);
    return glm::mix(of_row[columns[0]], of_row[columns[1]], x - left);
  };
  return glm::mix(along(row), along(row + 1), y - above);
}

Harmonics project(const LatLongMap& map) {
  std::array<glm::dvec3, kHarmonics> sums{};
  for (uint32_t y = 0; y < map.height_px; ++y) {
    const double solid_angle = map.solid_angle(y);
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const glm::dvec3 d = map.direction(x, y);
      double p[kHarmonics];
      harmonic_polynomials<double, double>(d.x, d.y, d.z, p);
      const glm::dvec3 light = solid_angle * glm::dvec3(map.radiance[size_t{y} * map.width_px + x]);
      for (size_t i = 0; i < kHarmonics; ++i) sums[i] += p[i] * light;
    }
  }
  Harmonics harmonics;
  for (size_t i = 0; i < kHarmonics; ++i) harmonics[i] = glm::vec3(sums[i]);
  return harmonics;
}

std::vector<glm::vec3> spread_directions(size_t count) {
  constexpr double kGolden_rad = kPi * (3 - 2.2360679774997896964);
  std::vector<glm::vec3> directions;
  for (size_t i = 0; i < count; ++i) {
    const double y = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double radius = std::sqrt(1 - y * y), angle = kGolden_rad * static_cast<double>(i);
    directions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
  }
  return directions;
}

glm::vec3 summed_irradiance(const LatLongMap& map, const glm::vec3& normal, float refractive_index) {
  glm::dvec3 sum(0);
  for (uint32_t y = 0; y < map.height_px; ++y) {
    const double solid_angle = map.solid_angle(y);
    for (uint32_t x = 0; x < map.width_px; ++x) {
      const float cosine = glm::dot(normal, map.direction(x, y));
      if (cosine <= 0) continue;
      const double share = solid_angle * cosine * fresnel_transmittance(refractive_index, cosine);
      sum += share * glm::dvec3(map.radiance[size_t{y} * map.width_px + x]);
    }
  }
  return glm::vec3(sum);
}

double harmonics_error(const LatLongMap& map, std::span<const glm::vec3> normals, float refractive_index) {
  const Harmonics harmonics = irradiance_harmonics(project(map), refractive_index);
  glm::dvec3 squares(0), mean(0);
  for (const glm::vec3& normal : normals) {
    const glm::dvec3 truth = summed_irradiance(map, normal, refractive_index);
    const glm::dvec3 off = glm::dvec3(evaluate(harmonics, normal)) - truth;
    squares += off * off;
    mean += truth;
  }
  const auto count = static_cast<double>(normals.size());
  double worst = 0;
  for (int c = 0; c < 3; ++c) {
    if (mean[c] > 0) worst = std::max(worst, std::sqrt(squares[c] / count) / (mean[c] / count));
  }
  return worst;
}

std::vector<EnvironmentLamp> take_out_lamps(LatLongMap& map, size_t max_lamps) {
  const double all = flux(map);
  const std::vector<glm::vec3> normals = spread_directions(kJudgedNormals);
  std::vector<EnvironmentLamp> lamps;
  while (lamps.size() < max_lamps) {
    if (harmonics_error(shrink(map, kJudgedHeight_px), normals, kJudgedIndex) <= kEnough) break;
    const EnvironmentLamp lamp = cut_lamp(brightest(shrink(map, kSearchedHeight_px)), map);
    if (luminance(lamp.irradiance) < kLeastShare * all) break;
    lamps.push_back(lamp);
  }
  return lamps;
}

EnvironmentLight analyse(LatLongMap map) {
  EnvironmentLight light;
  light.lamps = take_out_lamps(map);
  light.radiance = project(map);
  return light;
}

}  // namespace diaphane::optics

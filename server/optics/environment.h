// Light from all around, far away: a latitude-longitude map, told apart into lamps and the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glm/vec3.hpp"
#include "optics/harmonics.h"

namespace diaphane::optics {

/// Radiance, W·mm⁻²·sr⁻¹, linear RGB. Rows from the upper edge (+y) down; the middle column is −z, and +x right of it.
struct LatLongMap {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<glm::vec3> radiance;  ///< [height_px][width_px]

  /// Unit, of a pixel's centre.
  glm::vec3 direction(uint32_t x, uint32_t y) const;
  /// Of a pixel of that row, sr; the rows' add up to 4π.
  double solid_angle(uint32_t y) const;
};

/// A sun or lamp: as parallel light.
struct EnvironmentLamp {
  glm::vec3 direction{0, -1, 0};  ///< in which the light travels, unit
  glm::vec3 irradiance{0};        ///< W·mm⁻² on a surface that faces it
};

/// What the light of a map is to a body.
struct EnvironmentLight {
  Harmonics radiance{};  ///< of the map without its lamps
  std::vector<EnvironmentLamp> lamps;
};

/// Radiance that arrives from a unit direction of `map`, between its pixels bilinear; held over the poles.
glm::vec3 radiance_towards(const LatLongMap& map, const glm::vec3& direction);

/// Projects a map on polynomials; spread over the map's rows in order: the same bytes every time.
Harmonics project(const LatLongMap& map);

/// Takes lamps out of `map`, the brightest spot first, until the harmonics give E of what is left to about 1 % in every
/// channel, or `max_lamps` are out; `map` keeps what is left. Each is a patch of ten degrees around, down to the light
/// at its rim. Thread-safe.
std::vector<EnvironmentLamp> take_out_lamps(LatLongMap& map, size_t max_lamps = 12);

/// Both of them. `map` finite, at or above 0.
EnvironmentLight analyse(LatLongMap map);

/// E(N) by adding up every pixel, Fresnel inside (η = 1: none): the judge of the harmonics.
glm::vec3 summed_irradiance(const LatLongMap& map, const glm::vec3& normal, float refractive_index);

/// The harmonics' RMS error over `normals` against summed_irradiance(), over its mean; worst channel.
double harmonics_error(const LatLongMap& map, std::span<const glm::vec3> normals, float refractive_index);

/// `count` unit directions, evenly spread.
std::vector<glm::vec3> spread_directions(size_t count);

}  // namespace diaphane::optics

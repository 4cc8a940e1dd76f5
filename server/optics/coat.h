// What reflects on top of a body.
#pragma once

#include <array>
#include <cstddef>

#include "glm/vec2.hpp"
#include "glm/vec3.hpp"

namespace diaphane::optics {

/// The body's own interface to the air, as a microfacet surface (GGX).
struct Coat {
  float roughness = 0;  ///< GGX α, 0..1

  bool operator==(const Coat&) const = default;
};

/// GGX with the height-correlated Smith term (Heitz 2014) and dielectric Fresnel, balanced: f = F·D·G₂/(4·μi·μo) ·
/// s(μi)·s(μo), where s makes the whole reflectance at every angle what the smooth interface reflects, R(μ). So it is
/// reciprocal, and what enters the body, 1 − R(μ), is what the coat leaves it at any roughness. Immutable.
class BalancedCoat {
 public:
  /// `refractive_index` 1..3. A roughness below 0.001 is taken as that.
  BalancedCoat(const Coat& coat, float refractive_index);

  /// One way in which light may have come, and the weight of its radiance.
  struct Arrival {
    glm::vec3 direction{0};  ///< unit, to the light; z along the normal
    float weight = 0;        ///< f·μi over its density; 0 where it came from below
    float density = 0;       ///< sr⁻¹
  };

  /// Draws by the normals that `to_eye` (unit, z along the normal, z > 0) sees (Heitz 2018). `random`: 0..1 each.
  Arrival arrival(const glm::vec3& to_eye, const glm::vec2& random) const;

  /// f, sr⁻¹, between two unit directions, z along the normal; 0 where one is below.
  float reflectance(const glm::vec3& to_light, const glm::vec3& to_eye) const;

  /// R(μ) of the smooth interface.
  float albedo(float cosine) const;

  float alpha() const { return alpha_; }

 private:
  static constexpr size_t kNodes = 64;  ///< evenly in the root of μ

  float balance(float cosine) const;

  float alpha_;
  float refractive_index_;
  std::array<float, kNodes> balance_;
};

}  // namespace diaphane::optics

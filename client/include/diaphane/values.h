// Small values that the client's calls take and return. Colours are linear RGB throughout.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace diaphane {

/// Three coordinates. Lengths are in scene units (mesh units where a mesh says so), right-handed. Finite.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A place in a picture, 0..1 from its left and upper edges (glTF's convention); beyond that it repeats.
struct TextureCoordinate {
  float u = 0;
  float v = 0;

  friend bool operator==(const TextureCoordinate&, const TextureCoordinate&) = default;
};

/// Three linear channels, red, green and blue; the field that holds one says the unit.
struct Rgb {
  float r = 0;
  float g = 0;
  float b = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// A pinhole camera, right-handed, scene units. `up` need not be perpendicular to the view, but must not be parallel to
/// it.
struct Camera {
  Vec3 eye{0, 0, 1};
  Vec3 target{0, 0, 0};
  Vec3 up{0, 1, 0};
  float fov_y_deg = 30;  ///< full vertical angle, 1..170
};

/// Dipole coefficients of a material.
struct Coefficients {
  Rgb absorption_mm{0, 0, 0};          ///< σa in mm⁻¹, each 0..1000
  Rgb reduced_scattering_mm{1, 1, 1};  ///< σ's in mm⁻¹, each above 0, up to 1000
  float refractive_index = 1.3f;       ///< η, inside over outside, 1..3
};

/// The preset that is used where no material was asked for.
inline constexpr char kDefaultPreset[] = "marble";

/// What a body is made of: the name of a preset (Client::material_presets), or free coefficients.
struct Material {
  std::variant<std::string, Coefficients> model = std::string(kDefaultPreset);
};

/// A material that the server knows by name.
struct MaterialPreset {
  std::string name;
  Coefficients coefficients;
  std::string source;  ///< where the figures come from
};

/// Shines in all directions; irradiance falls with the square of the distance in millimetres.
struct PointLight {
  Vec3 position{0, 0, 0};       ///< scene units
  Rgb intensity_w_sr{0, 0, 0};  ///< W·sr⁻¹ per channel, each 0..1e12
  float radius_mm = 0;          ///< 0..1e6; above 0 it casts soft shadows
};

/// Parallel light from far away.
struct DirectionalLight {
  Vec3 direction{0, -1, 0};  ///< in which the light travels; any length but none
  Rgb irradiance{0, 0, 0};   ///< W·mm⁻² per channel on a surface that faces the light, each 0..1e12
};

/// A point light within a cone: full within the inner angle, none beyond the outer one, smooth between.
struct SpotLight {
  PointLight point;
  Vec3 direction{0, -1, 0};    ///< axis of the cone; any length but none
  float inner_angle_deg = 20;  ///< from the axis, 0..90, at most the outer one
  float outer_angle_deg = 30;  ///< from the axis, above 0, up to 90
};

using Light = std::variant<PointLight, DirectionalLight, SpotLight>;

}  // namespace diaphane

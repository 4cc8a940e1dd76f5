// Small values that the client's calls take and return. Colours are linear RGB throughout.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

/// An artist's form: the coefficients are those whose plane under even light has this colour.
struct DiffuseColor {
  Rgb color{0.8f, 0.8f, 0.8f};     ///< diffuse reflectance, each 0..0.999
  Rgb mean_free_path_mm{1, 1, 1};  ///< l = 1/(σa + σ's) in mm, each 0.001..1000
  float refractive_index = 1.3f;   ///< η, 1..3
};

/// glTF's KHR_materials_volume, and of the draft scattering extensions the multiple-scattering colour.
struct Volume {
  Rgb attenuation_color{0.5f, 0.5f, 0.5f};   ///< what is left after the distance, each above 0, up to 1; not all 1
  float attenuation_distance_mm = 1;         ///< 1e-6..1e6
  Rgb multiscatter_color{0.8f, 0.8f, 0.8f};  ///< each 0..0.999; not all 0
  float scatter_anisotropy = 0;              ///< g, the mean cosine of scattering, -0.99..0.99
  float refractive_index = 1.5f;             ///< η, 1..3
};

/// How light spreads below the surface, for Technique::kIntegral and kReference; the others always take the dipole.
/// Values are those of the contract.
enum class Profile {
  kDipole = 1,               ///< the classical dipole (Jensen et al. 2001)
  kBetterDipole = 2,         ///< the better dipole (d'Eon 2012)
  kNormalizedDiffusion = 3,  ///< normalized diffusion (Christensen and Burley 2015)
};

struct NamedProfile {
  std::string_view name;
  Profile profile;
};
inline constexpr NamedProfile kProfiles[] = {{"dipole", Profile::kDipole},
                                             {"better-dipole", Profile::kBetterDipole},
                                             {"normalized-diffusion", Profile::kNormalizedDiffusion}};

/// The body's own interface, smooth to rough (GGX): reflects lights and environment. What enters stays the same.
struct Coat {
  float roughness = 0;  ///< GGX α, 0..1; 0: a mirror
};

/// A texture of a scene, as the server named it: scenes/{scene}/textures/{texture}.
struct TextureHandle {
  std::string name;
};

/// Pictures on the surface of meshes with texture coordinates; each is applied once.
struct SurfaceTextures {
  std::optional<TextureHandle> albedo;     ///< multiplies what leaves the body
  std::optional<TextureHandle> normal;     ///< the coat's; tangent space, +y up; not of an sRGB texture
  std::optional<TextureHandle> roughness;  ///< green, squared, multiplies the coat's; not of an sRGB texture
  float normal_scale = 1;                  ///< of the normal map, above 0, up to 4
};

/// What a body is made of: the name of a preset (Client::material_presets), free coefficients, or another form that the
/// server turns into them.
struct Material {
  std::variant<std::string, Coefficients, DiffuseColor, Volume> model = std::string(kDefaultPreset);
  Profile profile = Profile::kDipole;
  std::optional<Coat> coat{};  ///< not given: none
  SurfaceTextures textures{};
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

// The forms in which a material may be said, and the coefficients that they come to.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "glm/vec3.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {

/// A preset's name; see find_preset().
struct PresetName {
  std::string name;
};

/// What the plane under even light looks like, and how far light goes.
struct DiffuseColor {
  glm::vec3 color{0.8f};           ///< diffuse reflectance, each 0..0.999
  glm::vec3 mean_free_path_mm{1};  ///< l = 1/σ't, each 0.001..1000
  float refractive_index = 1.3f;   ///< 1..3
};

/// KHR_materials_volume, with the draft scattering extensions' multiple-scattering colour.
struct Volume {
  glm::vec3 attenuation_color{1};     ///< what is left after the distance, each above 0, up to 1
  float attenuation_distance_mm = 1;  ///< 1e-6..1e6
  glm::vec3 multiscatter_color{0};    ///< each 0..0.999
  float scatter_anisotropy = 0;       ///< g, -0.99..0.99
  float refractive_index = 1.5f;      ///< 1..3
};

using MaterialForm = std::variant<PresetName, Coefficients, DiffuseColor, Volume>;

/// Coefficients, and what is doubtful about them, a sentence each.
struct ResolvedMaterial {
  Coefficients coefficients;
  std::vector<std::string> warnings;
};

/// What `form` comes to with `profile`; a form's own profile is not read. A DiffuseColor is inverted so that
/// total_reflectance() is the colour to 0.1 %. A channel that would scatter less than a millionth of what it takes out
/// gets that much. A Volume's reduced extinction is kept within 0.001..1000 mm⁻¹, with a warning. An unknown preset
/// comes to marble. Warned of besides: channels in which diffusion fails (see lowest_albedo()). Thread-safe.
ResolvedMaterial resolve(const MaterialForm& form, Profile profile);

/// The share 1 − α' that a channel must absorb at each event for its plane to reflect `color` (0..0.999).
double absorbed_share(Profile profile, double color, double refractive_index);

/// The α' below which a profile's light would fall off faster (σ) than light that is not scattered at all (σ't), which
/// nothing does: 2/3 for the dipole, 1/2 for the better dipole with Grosjean's D; 0 for normalized diffusion, which is
/// fitted to transport at every albedo.
double lowest_albedo(Profile profile);

}  // namespace diaphane::optics

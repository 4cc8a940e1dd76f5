// Scenes as JSON files.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/render_options.h"
#include "diaphane/values.h"

namespace diaphane {

/// What a scene file says, in the contract's own JSON form (field names in either spelling, snake_case or camelCase):
///
///     {"scene":     {"display_name": "Bunny", "millimetres_per_unit": 130},
///      "materials": [{"name": "skin", "preset": "skin1"},
///                    {"name": "mine", "coefficients": {"absorption_mm": {"x": 0.1, "y": 0.2, "z": 0.3},
///                                                      "reduced_scattering_mm": {"x": 1, "y": 1, "z": 1}}},
///                    {"name": "pink", "diffuse_color": {"color": {"x": 0.9, "y": 0.5, "z": 0.5},
///                                                       "mean_free_path_mm": {"x": 1, "y": 0.5, "z": 0.5}},
///                     "profile": "PROFILE_BETTER_DIPOLE"}],
///      "lights":    [{"point": {"position": {"x": 0, "y": 1, "z": 2}, "intensity": {"x": 900, "y": 900, "z": 900}}}],
///      "meshes":    [{"file": "bunny.ply", "material": "skin", "scene_from_mesh": [1, 0, ...]}],
///      "camera":    {"eye": {...}, "target": {...}, "up": {...}, "fov_y_deg": 30},
///      "settings":  {"technique": "TECHNIQUE_PAPER", "paper": {"terms": "TERMS_LOCAL"}, "exposure_ev": 1},
///      "size":      {"width_px": 640, "height_px": 480}}
///
/// Only meshes must be there. `name` is how meshes of this file refer to a material, and must be its own; a mesh
/// without a material has its file's own, or else kDefaultPreset. The `textures` of a material are files (PNG, JPEG,
/// WebP):
/// `{"albedo": "skin.png", "normal": "pores.png", "roughness": "oil.png", "normal_scale": 1}`. A file is relative to
/// the scene file and does not leave its folder; its own placement is applied before `scene_from_mesh`.
struct SceneFile {
  struct NamedMaterial {
    std::string name;
    Material material;                                               ///< without textures, but for normal_scale
    std::filesystem::path albedo_file, normal_file, roughness_file;  ///< the scene file's folder included; empty: none
  };
  struct MeshFile {
    std::filesystem::path path;      ///< the scene file's folder included
    std::optional<size_t> material;  ///< into `materials`
    std::array<float, 16> scene_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  };

  std::string display_name;
  std::optional<double> millimetres_per_unit;
  std::vector<NamedMaterial> materials;
  std::vector<Light> lights;
  std::vector<MeshFile> meshes;
  std::optional<Camera> camera;
  RenderSettings settings;
  std::optional<Size> size;
};

/// Reads a scene file of at most 16 MiB, but not the meshes that it names.
///
/// Errors, each one line that starts with the path: NOT_FOUND no such file; PERMISSION_DENIED it cannot be opened;
/// INVALID_ARGUMENT it is not JSON, or has a field that is unknown, given twice, set by the server alone, or wrong;
/// RESOURCE_EXHAUSTED it is too long. Thread-safe.
absl::StatusOr<SceneFile> read_scene_file(const std::filesystem::path& path);

}  // namespace diaphane

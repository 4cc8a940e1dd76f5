// The render command's options, as they were given.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diaphane/render_options.h"
#include "diaphane/values.h"
#include "parse.h"

namespace diaphane::cli {

struct RenderArguments {
  std::vector<std::string> meshes;
  std::string scene_file;
  std::string output;
  ImageFormat format = ImageFormat::kPng;  ///< by the output's extension
  std::optional<Size> size;
  std::optional<std::vector<Channel>> channels;

  std::optional<Technique> technique;
  std::optional<Quality> quality;
  std::optional<Shadows> shadows;
  bool slab_correction = false;
  std::optional<Terms> terms;
  std::optional<uint32_t> kernel_taps;
  std::optional<uint32_t> face_size_px;
  std::optional<float> global_gain;
  std::optional<Exposure> exposure;
  std::optional<ToneMapping> tone_mapping;
  std::optional<uint32_t> samples;
  std::optional<Background> background;

  std::optional<std::string> preset;
  std::optional<Rgb> absorption_mm;
  std::optional<Rgb> reduced_scattering_mm;
  std::optional<Rgb> diffuse_color;
  std::optional<Rgb> mean_free_path_mm;
  std::optional<float> refractive_index;
  std::optional<Profile> profile;
  bool coat = false;
  std::optional<float> roughness;

  std::optional<double> millimetres_per_unit;
  std::optional<double> height_mm;

  std::optional<Vec3> eye;
  std::optional<Vec3> target;
  std::optional<Vec3> up;
  std::optional<float> fov_y_deg;

  std::vector<Light> lights;
  std::string environment_file;
  std::optional<float> environment_rotation_deg;
  std::optional<float> environment_intensity;
  bool environment_occlusion = false;
};

/// Declares on `command` the options that say what is shown and how; parsing fills `arguments`, which must live as
/// long. What cannot be parsed, is missing or excludes another option is a CLI::ParseError that names the flag; ranges
/// that the server knows are left to it.
void add_scene_options(CLI::App& command, RenderArguments& arguments);

/// The same, and where one picture goes.
void add_render_options(CLI::App& command, RenderArguments& arguments);

}  // namespace diaphane::cli

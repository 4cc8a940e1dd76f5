#include "render_arguments.h"

#include "fmt/format.h"
#include "parse.h"

namespace diaphane::cli {
namespace {

template <typename Value>
using Parse = std::optional<Value> (*)(std::string_view);

template <typename Value>
Value parsed(const std::string& flag, const std::string& form, Parse<Value> parse, const std::string& text) {
  const std::optional<Value> value = parse(text);
  if (!value) throw CLI::ValidationError(flag, fmt::format("must be {}, got '{}'", form, text));
  return *value;
}

// An option whose text `parse` turns into a value; `form` says what it must look like.
template <typename Value>
CLI::Option* add_parsed(CLI::App& command, const std::string& flag, const std::string& form, const std::string& help,
                        Parse<Value> parse, std::optional<Value>& value) {
  return command
      .add_option_function<std::string>(
          flag, [=, &value](const std::string& text) { value = parsed(flag, form, parse, text); }, help)
      ->type_name(form);
}

std::optional<float> parse_number(std::string_view text) {
  float number = 0;
  if (!parse_numbers(text, {&number, 1})) return std::nullopt;
  return number;
}

std::optional<double> parse_above_zero(std::string_view text) {
  const std::optional<float> number = parse_number(text);
  if (!number || *number <= 0) return std::nullopt;
  return *number;
}

std::optional<Rgb> parse_rgb_or_grey(std::string_view text) {
  if (const std::optional<float> grey = parse_number(text)) return Rgb{*grey, *grey, *grey};
  return parse_rgb(text);
}

// 0 means "not given" in the contract, and would be taken for the default.
std::optional<float> parse_index(std::string_view text) {
  const std::optional<float> number = parse_number(text);
  if (!number || *number == 0) return std::nullopt;
  return number;
}

std::optional<uint32_t> parse_count(std::string_view text) {
  const std::optional<Size> size = parse_size(fmt::format("{}x1", text));
  if (!size) return std::nullopt;
  return size->width_px;
}

std::optional<Technique> parse_technique(std::string_view text) {
  for (const NamedTechnique& entry : kTechniques) {
    if (entry.name == text) return entry.technique;
  }
  return std::nullopt;
}

std::optional<Quality> parse_quality(std::string_view text) {
  for (const NamedQuality& entry : kQualities) {
    if (entry.name == text) return entry.quality;
  }
  return std::nullopt;
}

std::optional<Shadows> parse_shadows(std::string_view text) {
  for (const NamedShadows& entry : kShadows) {
    if (entry.name == text) return entry.shadows;
  }
  return std::nullopt;
}

std::optional<Profile> parse_profile(std::string_view text) {
  for (const NamedProfile& entry : kProfiles) {
    if (entry.name == text) return entry.profile;
  }
  return std::nullopt;
}

std::optional<Terms> parse_terms(std::string_view text) {
  for (const NamedTerms& entry : kTerms) {
    if (entry.name == text) return entry.terms;
  }
  return std::nullopt;
}

std::optional<ToneMapping> parse_tone_mapping(std::string_view text) {
  for (const NamedToneMapping& entry : kToneMappings) {
    if (entry.name == text) return entry.tone_mapping;
  }
  return std::nullopt;
}

void add_material_options(CLI::App& command, RenderArguments& arguments) {
  auto* material = command.add_option("--material", arguments.preset, "Material preset; see 'diaphane materials'");
  material->type_name("NAME");
  auto* absorption =
      add_parsed(command, "--absorption", "R,G,B", "Absorption in mm^-1", parse_rgb, arguments.absorption_mm);
  auto* scattering = add_parsed(command, "--scattering", "R,G,B", "Reduced scattering in mm^-1", parse_rgb,
                                arguments.reduced_scattering_mm);
  auto* color = add_parsed(command, "--diffuse-color", "R,G,B",
                           "What the body looks like under even light, linear, each 0 to 0.999; with --mean-free-path",
                           parse_rgb, arguments.diffuse_color);
  auto* path = add_parsed(command, "--mean-free-path", "R,G,B|L",
                          "How far light goes in the body between events in mm, each 0.001 to 1000", parse_rgb_or_grey,
                          arguments.mean_free_path_mm);
  color->excludes(material)->excludes(absorption)->excludes(scattering)->needs(path);
  path->needs(color);
  absorption->excludes(material)->needs(scattering);
  scattering->excludes(material)->needs(absorption);
  add_parsed(command, "--ior", "N", "Refractive index, 1 to 3", parse_index, arguments.refractive_index);
  add_parsed(command, "--profile", profile_names(), "How light spreads below the surface (default: dipole)",
             parse_profile, arguments.profile);
  auto* coat = command.add_flag("--coat", arguments.coat, "The body's interface reflects lights and environment");
  add_parsed(command, "--roughness", "A", "Of the coat, GGX alpha, 0 to 1 (default: 0.1)", parse_number,
             arguments.roughness)
      ->needs(coat);
}

void add_camera_options(CLI::App& command, RenderArguments& arguments) {
  add_parsed(command, "--eye", "X,Y,Z", "Where the camera stands (default: framed on the meshes)", parse_vec3,
             arguments.eye);
  add_parsed(command, "--target", "X,Y,Z", "What it looks at", parse_vec3, arguments.target);
  add_parsed(command, "--up", "X,Y,Z", "Which way is up, also for --height-mm (default: 0,1,0)", parse_vec3,
             arguments.up);
  add_parsed(command, "--fov", "DEG", "Full vertical field of view (default: 30)", parse_number, arguments.fov_y_deg);
}

void add_technique_options(CLI::App& command, RenderArguments& arguments) {
  add_parsed(command, "--technique", technique_names(), "How light inside the body is found", parse_technique,
             arguments.technique);
  add_parsed(command, "--quality", quality_names(), "Of the integral (default: normal)", parse_quality,
             arguments.quality);
  add_parsed(command, "--shadows", shadows_names(),
             "Whether meshes hide lights (default: on for integral and reference, else off)", parse_shadows,
             arguments.shadows);
  command.add_flag("--slab-correction", arguments.slab_correction,
                   "Of the integral and the reference: thin parts give back what a slab would");
  add_parsed(command, "--terms", terms_names(), "Which part of the paper technique's answer", parse_terms,
             arguments.terms);
  add_parsed(command, "--kernel", "N", "Taps a side of the paper technique's kernel, 3 to 6", parse_count,
             arguments.kernel_taps);
  add_parsed(command, "--face-size", "N", "Edge of its cube faces in texels, 16 to 2048", parse_count,
             arguments.face_size_px);
  add_parsed(command, "--global-gain", "G", "Multiplies its global term", parse_number, arguments.global_gain);
}

void add_picture_options(CLI::App& command, RenderArguments& arguments) {
  add_parsed(command, "--samples", "N", "A pixel, 1 to 64 (default: 1)", parse_count, arguments.samples);
  add_parsed(command, "--background", "R,G,B | environment",
             "Linear colour, or the environment, where nothing is (default: transparent)", parse_background,
             arguments.background);
  add_parsed(command, "--exposure", "EV | auto[+-EV]", "Stops, or found for the frame; not applied to EXR",
             parse_exposure, arguments.exposure);
  add_parsed(command, "--tone-mapping", tone_mapping_names(), "How bright light is shown (default: none, it is cut)",
             parse_tone_mapping, arguments.tone_mapping);
}

// Lights of one form; the flag may be repeated.
void add_lights(CLI::App& command, const std::string& flag, const std::string& form, const std::string& help,
                Parse<Light> parse, std::vector<Light>& lights) {
  command
      .add_option_function<std::vector<std::string>>(
          flag,
          [=, &lights](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) lights.push_back(parsed(flag, form, parse, text));
          },
          help)
      ->type_name(form)
      ->allow_extra_args(false);
}

}  // namespace

void add_scene_options(CLI::App& command, RenderArguments& arguments) {
  auto* meshes = command.add_option("MESH", arguments.meshes, "Mesh files: .gltf, .glb, .obj, .ply, .stl, .off");
  auto* scene =
      command.add_option("--scene", arguments.scene_file, "A scene file in place of meshes, materials, lights");
  scene->type_name("FILE.json")->excludes(meshes);
  add_parsed(command, "--size", "WxH", "Pixels (default: 1280x720)", parse_size, arguments.size);
  add_technique_options(command, arguments);
  add_picture_options(command, arguments);
  add_material_options(command, arguments);
  auto* unit = add_parsed(command, "--mm-per-unit", "S", "Size of a mesh unit in millimetres, above 0",
                          parse_above_zero, arguments.millimetres_per_unit);
  auto* height = add_parsed(command, "--height-mm", "H", "Height along the up vector in millimetres, above 0",
                            parse_above_zero, arguments.height_mm);
  height->excludes(unit);
  add_camera_options(command, arguments);
  add_lights(command, "--point-light", "X,Y,Z,R,G,B",
             "A point light: mesh units, then W/sr; may be repeated (default: one key light)", parse_point_light,
             arguments.lights);
  add_lights(command, "--directional-light", "DX,DY,DZ,R,G,B",
             "Parallel light: the way in which it shines, then W/mm^2; may be repeated", parse_directional_light,
             arguments.lights);
  add_lights(command, "--spot-light", "X,Y,Z,DX,DY,DZ,INNER,OUTER,R,G,B",
             "A spot: place, axis, angles from the axis in degrees, W/sr; may be repeated", parse_spot_light,
             arguments.lights);
  auto* environment = command.add_option("--environment", arguments.environment_file,
                                         "Light from all around: a latitude-longitude map, .hdr or .exr");
  environment->type_name("FILE");
  add_parsed(command, "--environment-rotation", "DEG", "Turns it about +y, counter-clockwise from above", parse_number,
             arguments.environment_rotation_deg)
      ->needs(environment);
  add_parsed(command, "--environment-intensity", "X", "Multiplies it (default: 1)", parse_number,
             arguments.environment_intensity)
      ->needs(environment);
  command
      .add_flag("--environment-occlusion", arguments.environment_occlusion, "Bodies hide parts of it from each other")
      ->needs(environment);
  for (const char* flag :
       {"--material", "--absorption", "--scattering", "--diffuse-color", "--mean-free-path", "--ior", "--profile",
        "--coat", "--mm-per-unit", "--height-mm", "--point-light", "--directional-light", "--spot-light"}) {
    scene->excludes(command.get_option(flag));
  }
}

void add_render_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option_function<std::string>(
          "-o,--output",
          [&arguments](const std::string& path) {
            const std::optional<ImageFormat> format = format_of(path);
            if (!format) {
              throw CLI::ValidationError("-o",
                                         fmt::format("must end in .png, .jpg, .jpeg, .webp or .exr, got '{}'", path));
            }
            arguments.output = path;
            arguments.format = *format;
          },
          "The image: .png, .jpg, .webp or .exr (linear radiance)")
      ->type_name("FILE")
      ->required();
  add_parsed(command, "--aov", channel_names(), "Extra channels of an EXR, as 32-bit floats", parse_channels,
             arguments.channels);
  add_scene_options(command, arguments);
}

}  // namespace diaphane::cli

// Option values from text.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "diaphane/render_options.h"
#include "diaphane/values.h"

namespace diaphane::cli {

/// Exactly `numbers.size()` finite numbers between commas. False, and nothing is written, for anything else.
bool parse_numbers(std::string_view text, std::span<float> numbers);

std::optional<Vec3> parse_vec3(std::string_view text);  ///< X,Y,Z
std::optional<Rgb> parse_rgb(std::string_view text);    ///< R,G,B
/// X,Y,Z,R,G,B: scene units, then W/sr.
std::optional<Light> parse_point_light(std::string_view text);
/// DX,DY,DZ,R,G,B: the way in which it shines, then W/mm² on a surface that faces it.
std::optional<Light> parse_directional_light(std::string_view text);
/// X,Y,Z,DX,DY,DZ,INNER,OUTER,R,G,B: place, axis, angles from the axis in degrees, W/sr.
std::optional<Light> parse_spot_light(std::string_view text);
/// Names between commas, each once.
std::optional<std::vector<Channel>> parse_channels(std::string_view text);
/// "auto", or stops that "auto" may be followed by: auto, -1.5, auto+1, auto-0.5.
struct Exposure {
  bool found = false;
  float ev = 0;
};
std::optional<Exposure> parse_exposure(std::string_view text);
/// "environment", or R,G,B.
struct Background {
  std::optional<Rgb> color;
  bool environment = false;
};
std::optional<Background> parse_background(std::string_view text);
std::optional<Size> parse_size(std::string_view text);  ///< WxH, both above 0

/// By the file's extension, in any case.
std::optional<ImageFormat> format_of(const std::filesystem::path& path);

/// The names, with " | " between them; of channels, with commas.
std::string technique_names();
std::string quality_names();
std::string profile_names();
std::string shadows_names();
std::string terms_names();
std::string channel_names();
std::string tone_mapping_names();

}  // namespace diaphane::cli

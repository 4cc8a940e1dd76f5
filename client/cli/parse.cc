#include "parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace diaphane::cli {
namespace {

template <typename Number>
bool parse_whole(std::string_view text, Number* number) {
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, *number);
  return error == std::errc() && end == last;
}

template <typename Named>
std::string joined(std::span<const Named> table, std::string_view separator = " | ") {
  std::vector<std::string_view> names;
  for (const Named& entry : table) names.push_back(entry.name);
  return fmt::format("{}", fmt::join(names, separator));
}

}  // namespace

bool parse_numbers(std::string_view text, std::span<float> numbers) {
  std::vector<float> parsed;
  while (true) {
    const size_t comma = text.find(',');
    float number = 0;
    if (!parse_whole(text.substr(0, comma), &number) || !std::isfinite(number)) return false;
    parsed.push_back(number);
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  if (parsed.size() != numbers.size()) return false;
  std::copy(parsed.begin(), parsed.end(), numbers.begin());
  return true;
}

std::optional<Vec3> parse_vec3(std::string_view text) {
  std::array<float, 3> n;
  if (!parse_numbers(text, n)) return std::nullopt;
  return Vec3{n[0], n[1], n[2]};
}

std::optional<Rgb> parse_rgb(std::string_view text) {
  std::array<float, 3> n;
  if (!parse_numbers(text, n)) return std::nullopt;
  return Rgb{n[0], n[1], n[2]};
}

std::optional<Light> parse_point_light(std::string_view text) {
  std::array<float, 6> n;
  if (!parse_numbers(text, n)) return std::nullopt;
  return PointLight{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

std::optional<Light> parse_directional_light(std::string_view text) {
  std::array<float, 6> n;
  if (!parse_numbers(text, n)) return std::nullopt;
  return DirectionalLight{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

std::optional<Light> parse_spot_light(std::string_view text) {
  std::array<float, 11> n;
  if (!parse_numbers(text, n)) return std::nullopt;
  return SpotLight{{{n[0], n[1], n[2]}, {n[8], n[9], n[10]}}, {n[3], n[4], n[5]}, n[6], n[7]};
}

std::optional<std::vector<Channel>> parse_channels(std::string_view text) {
  std::vector<Channel> channels;
  while (true) {
    const size_t comma = text.find(',');
    const auto* found = std::find_if(std::begin(kChannels), std::end(kChannels),
                                     [&](const NamedChannel& entry) { return entry.name == text.substr(0, comma); });
    if (found == std::end(kChannels)) return std::nullopt;
    if (std::find(channels.begin(), channels.end(), found->channel) != channels.end()) return std::nullopt;
    channels.push_back(found->channel);
    if (comma == std::string_view::npos) return channels;
    text.remove_prefix(comma + 1);
  }
}

std::optional<Background> parse_background(std::string_view text) {
  if (text == "environment") return Background{.environment = true};
  const std::optional<Rgb> color = parse_rgb(text);
  if (!color) return std::nullopt;
  return Background{.color = color};
}

std::optional<Exposure> parse_exposure(std::string_view text) {
  constexpr std::string_view kAuto = "auto";
  Exposure exposure;
  exposure.found = text.substr(0, kAuto.size()) == kAuto;
  if (exposure.found) text.remove_prefix(kAuto.size());
  if (exposure.found && text.empty()) return exposure;
  if (exposure.found && text.front() != '+' && text.front() != '-') return std::nullopt;
  if (text.substr(0, 1) == "+") text.remove_prefix(1);
  if (!parse_numbers(text, std::span<float>(&exposure.ev, 1))) return std::nullopt;
  return exposure;
}

std::optional<Size> parse_size(std::string_view text) {
  const size_t x = text.find('x');
  Size size;
  if (x == std::string_view::npos || !parse_whole(text.substr(0, x), &size.width_px) ||
      !parse_whole(text.substr(x + 1), &size.height_px) || size.width_px == 0 || size.height_px == 0) {
    return std::nullopt;
  }
  return size;
}

std::optional<ImageFormat> format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".png") return ImageFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::kJpeg;
  if (extension == ".webp") return ImageFormat::kWebp;
  if (extension == ".exr") return ImageFormat::kExr;
  return std::nullopt;
}

std::string technique_names() { return joined(std::span<const NamedTechnique>(kTechniques)); }

std::string quality_names() { return joined(std::span<const NamedQuality>(kQualities)); }

std::string profile_names() { return joined(std::span<const NamedProfile>(kProfiles)); }

std::string shadows_names() { return joined(std::span<const NamedShadows>(kShadows)); }

std::string channel_names() { return joined(std::span<const NamedChannel>(kChannels), ","); }

std::string tone_mapping_names() { return joined(std::span<const NamedToneMapping>(kToneMappings)); }

std::string terms_names() { return joined(std::span<const NamedTerms>(kTerms)); }

}  // namespace diaphane::cli

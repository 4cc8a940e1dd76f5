#include "terminal_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>

#include "absl/strings/escaping.h"
#include "fmt/format.h"

namespace diaphane::cli {
namespace {

// What kitty's protocol takes at once.
constexpr size_t kChunkBytes = 4096;
constexpr uint32_t kLongestSide_px = 1024;
// Of a cell, where the terminal does not say.
constexpr uint32_t kCellWidth_px = 8, kCellHeight_px = 16;

constexpr std::array<std::pair<std::string_view, PictureProtocol>, 3> kNames = {
    {{"kitty", PictureProtocol::kKitty}, {"iterm", PictureProtocol::kITerm}, {"blocks", PictureProtocol::kBlocks}}};

using Rgb8 = std::array<uint8_t, 3>;

Rgb8 over_black(const uint8_t* rgba) {
  const auto channel = [&](int i) { return static_cast<uint8_t>((rgba[i] * rgba[3] + 127) / 255); };
  return {channel(0), channel(1), channel(2)};
}

uint32_t picture_rows(const TerminalExtent& extent) { return std::max(extent.rows, 2u) - 1; }

}  // namespace

std::optional<PictureProtocol> picture_protocol_of(std::string_view name) {
  const auto found = std::find_if(kNames.begin(), kNames.end(), [&](const auto& known) { return known.first == name; });
  return found != kNames.end() ? std::optional(found->second) : std::nullopt;
}

std::string picture_protocol_names() {
  std::string names;
  for (const auto& [name, protocol] : kNames) names += fmt::format("{}{}", names.empty() ? "" : " | ", name);
  return names;
}

PictureProtocol found_picture_protocol(absl::FunctionRef<const char*(const char*)> variable) {
  const auto value = [&](const char* name) {
    const char* text = variable(name);
    return std::string_view(text != nullptr ? text : "");
  };
  // What runs inside passes no pictures on.
  if (!value("TMUX").empty() || value("TERM").starts_with("screen")) return PictureProtocol::kBlocks;
  const std::string_view program = value("TERM_PROGRAM");
  for (const std::string_view name : {"iTerm.app", "WezTerm", "mintty"}) {
    if (program == name) return PictureProtocol::kITerm;
  }
  const bool is_kitty = value("TERM").find("kitty") != std::string_view::npos || program == "ghostty" ||
                        !value("KITTY_WINDOW_ID").empty() || !value("KONSOLE_VERSION").empty();
  return is_kitty ? PictureProtocol::kKitty : PictureProtocol::kBlocks;
}

Size picture_size(PictureProtocol protocol, const TerminalExtent& extent) {
  const uint32_t columns = std::max(extent.columns, 1u), rows = picture_rows(extent);
  double width = columns, height = 2.0 * rows;
  if (protocol != PictureProtocol::kBlocks) {
    const bool known = extent.width_px > 0 && extent.height_px > 0;
    width = known ? 1.0 * extent.width_px : 1.0 * kCellWidth_px * columns;
    height = known ? 1.0 * extent.height_px * rows / std::max(extent.rows, 2u) : 1.0 * kCellHeight_px * rows;
  }
  const double scale = std::min(1.0, kLongestSide_px / std::max(width, height));
  const auto side = [&](double length) { return static_cast<uint32_t>(std::max(1.0, std::floor(scale * length))); };
  // Blocks are of two rows each.
  const uint32_t height_px = protocol == PictureProtocol::kBlocks ? std::max(side(height) / 2 * 2, 2u) : side(height);
  return {side(width), height_px};
}

ImageFormat picture_format(PictureProtocol protocol) {
  // Kitty's protocol has no JPEG; what half blocks show is a few kilobytes.
  return protocol == PictureProtocol::kITerm ? ImageFormat::kJpeg : ImageFormat::kPng;
}

std::string picture_text(PictureProtocol protocol, std::string_view file, const TerminalExtent& extent) {
  const std::string coded = absl::Base64Escape({file.data(), file.size()});
  const uint32_t rows = picture_rows(extent);
  if (protocol == PictureProtocol::kITerm) {
    return fmt::format("\x1b[H\x1b]1337;File=inline=1;size={};width={};height={};preserveAspectRatio=0:{}\a",
                       file.size(), extent.columns, rows, coded);
  }
  // One picture that each takes the place of, without answers, and with the cursor where it was.
  std::string text = fmt::format("\x1b[H\x1b_Ga=T,f=100,i=1,p=1,q=2,C=1,c={},r={},", extent.columns, rows);
  for (size_t first = 0; first < coded.size(); first += kChunkBytes) {
    const bool more = coded.size() - first > kChunkBytes;
    if (first > 0) text += "\x1b_G";
    fmt::format_to(std::back_inserter(text), "m={};{}\x1b\\", more ? 1 : 0,
                   std::string_view(coded).substr(first, kChunkBytes));
  }
  return text;
}

std::string blocks_text(const TextureData& picture) {
  std::string text;
  for (uint32_t row = 0; row + 1 < picture.height_px; row += 2) {
    fmt::format_to(std::back_inserter(text), "\x1b[{};1H", row / 2 + 1);
    std::optional<Rgb8> above, below;
    for (uint32_t x = 0; x < picture.width_px; ++x) {
      const uint8_t* pixel = &picture.rgba[4 * (size_t{row} * picture.width_px + x)];
      const Rgb8 upper = over_black(pixel), lower = over_black(pixel + 4 * size_t{picture.width_px});
      if (above != upper) fmt::format_to(std::back_inserter(text), "\x1b[38;2;{}m", fmt::join(upper, ";"));
      if (below != lower) fmt::format_to(std::back_inserter(text), "\x1b[48;2;{}m", fmt::join(lower, ";"));
      above = upper;
      below = lower;
      text += "▀";
    }
    text += "\x1b[0m";
  }
  return text;
}

}  // namespace diaphane::cli

#include "readers/colour.h"

#include <algorithm>
#include <cmath>

namespace diaphane::readers {
namespace {

bool is_above_one(const Rgb& colour) { return colour.r > 1 || colour.g > 1 || colour.b > 1; }

bool is_number(const Rgb& colour) { return !std::isnan(colour.r) && !std::isnan(colour.g) && !std::isnan(colour.b); }

}  // namespace

float linear_from_srgb(float coded) {
  return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f);
}

void make_linear(std::vector<Rgb>& colours, ColourCoding coding) {
  const bool bytes = coding == ColourCoding::kSrgbOrBytes && std::any_of(colours.begin(), colours.end(), is_above_one);
  const float scale = bytes ? 1 / 255.0f : 1.0f;
  const auto linear = [&](float value) {
    const float cut = std::clamp(value * scale, 0.0f, 1.0f);
    return coding == ColourCoding::kLinear ? cut : linear_from_srgb(cut);
  };
  for (Rgb& colour : colours) {
    colour = is_number(colour) ? Rgb{linear(colour.r), linear(colour.g), linear(colour.b)} : Rgb{1, 1, 1};
  }
}

}  // namespace diaphane::readers

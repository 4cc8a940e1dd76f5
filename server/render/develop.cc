#include "render/develop.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr double kBright = 0.98;          // the share of the body below ...
constexpr float kBrightLuminance = 0.8f;  // ... this
constexpr float kShoulder = 0.8f;
constexpr float kDesaturation = 0.15f;

struct Pixel {
  glm::vec3 colour;
  float alpha;
};

/// Without the alpha that its colour is multiplied by.
Pixel pixel_of(const base::ImageF& picture, size_t i) {
  const float* v = &picture.values[i * picture.channels.size()];
  if (!(v[3] > 0)) return {glm::vec3(0), 0};
  return {glm::vec3(v[0], v[1], v[2]) / v[3], v[3]};
}

size_t pixel_count(const base::ImageF& picture) { return picture.values.size() / picture.channels.size(); }

template <typename Work>
void for_each_pixel(size_t count, const Work& work) {
  constexpr size_t kGrain = 4096;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kGrain), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

}  // namespace

float encode_srgb(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

uint8_t to_byte(float value) { return static_cast<uint8_t>(std::lround(255 * value)); }

float find_exposure_ev(const base::ImageF& picture) {
  std::vector<float> luminances;
  for (size_t i = 0; i < pixel_count(picture); ++i) {
    const Pixel pixel = pixel_of(picture, i);
    if (pixel.alpha > 0) {
      luminances.push_back(0.2126f * pixel.colour.r + 0.7152f * pixel.colour.g + 0.0722f * pixel.colour.b);
    }
  }
  if (luminances.empty()) return 0;
  const auto at = luminances.begin() + static_cast<ptrdiff_t>(kBright * static_cast<double>(luminances.size() - 1));
  std::nth_element(luminances.begin(), at, luminances.end());
  return std::isnormal(*at) && *at > 0 ? std::log2(kBrightLuminance / *at) : 0.0f;
}

void lay_over(const glm::vec3& background, base::ImageF& picture) {
  const size_t stride = picture.channels.size();
  for_each_pixel(pixel_count(picture), [&](size_t i) {
    float* v = &picture.values[i * stride];
    for (int c = 0; c < 3; ++c) v[c] += (1 - v[3]) * background[c];
    v[3] = 1;
  });
}

glm::vec3 tone_map_neutral(const glm::vec3& colour) {
  const float peak = std::max({colour.r, colour.g, colour.b});
  if (peak <= kShoulder) return colour;
  constexpr float kRest = 1 - kShoulder;
  const float new_peak = 1 - kRest * kRest / (peak + kRest - kShoulder);
  const float grey = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
  return (1 - grey) * (colour * (new_peak / peak)) + grey * glm::vec3(new_peak);
}

base::Image8 develop(const base::ImageF& picture, float exposure_ev, ToneMapping tone_mapping) {
  base::Image8 image{picture.width_px, picture.height_px, std::vector<uint8_t>(4 * pixel_count(picture))};
  const float scale = std::exp2(exposure_ev);
  for_each_pixel(pixel_count(picture), [&](size_t i) {
    const Pixel pixel = pixel_of(picture, i);
    // So that what overflows is white.
    glm::vec3 colour = glm::clamp(scale * pixel.colour, 0.0f, 1e30f);
    if (tone_mapping == ToneMapping::kNeutral) colour = tone_map_neutral(colour);
    for (int c = 0; c < 3; ++c) image.rgba[4 * i + c] = to_byte(encode_srgb(colour[c]));
    image.rgba[4 * i + 3] = to_byte(std::min(pixel.alpha, 1.0f));
  });
  return image;
}

}  // namespace diaphane::render

#include "render/pixels.h"

#include <cstring>
#include <utility>

#include "render/channels.h"
#include "render/develop.h"

namespace diaphane::render {

Canvas make_canvas(Frame& frame, const FrameRequest& request, PixelFormat format) {
  const size_t pixels = size_t{request.width_px} * request.height_px;
  if (format == PixelFormat::kSrgb8) {
    std::vector<uint8_t> rgba;
    if (auto* spare = std::get_if<base::Image8>(&frame.image)) rgba = std::move(spare->rgba);
    rgba.resize(4 * pixels);
    auto& image = frame.image.emplace<base::Image8>(base::Image8{request.width_px, request.height_px, std::move(rgba)});
    return {image.rgba.data(), request.width_px, request.height_px, 4};
  }
  std::vector<std::string> names = channel_names(request.channels);
  std::vector<float> values;
  if (auto* spare = std::get_if<base::ImageF>(&frame.image)) values = std::move(spare->values);
  values.resize(names.size() * pixels);
  const size_t pixel_bytes = names.size() * sizeof(float);
  auto& image = frame.image.emplace<base::ImageF>(
      base::ImageF{request.width_px, request.height_px, std::move(names), std::move(values)});
  return {reinterpret_cast<uint8_t*>(image.values.data()), request.width_px, request.height_px, pixel_bytes};
}

void store_pixels(std::span<const glm::vec4> radiance, float radiance_scale, PixelFormat format, uint8_t* pixels) {
  if (format == PixelFormat::kLinearFloat) {
    std::memcpy(pixels, radiance.data(), radiance.size_bytes());
    return;
  }
  for (size_t i = 0; i < radiance.size(); ++i) {
    for (int c = 0; c < 3; ++c) pixels[4 * i + c] = to_byte(encode_srgb(radiance_scale * radiance[i][c]));
    pixels[4 * i + 3] = to_byte(radiance[i].a);
  }
}

}  // namespace diaphane::render

#include "render/channels.h"

#include <algorithm>
#include <limits>

#include "glm/geometric.hpp"

namespace diaphane::render {
namespace {

constexpr size_t kColourChannels = 4;

std::vector<const char*> names_of(Channel channel) {
  switch (channel) {
    case Channel::kIrradiance:
      return {"irradiance.R", "irradiance.G", "irradiance.B"};
    case Channel::kRadiosity:
      return {"radiosity.R", "radiosity.G", "radiosity.B"};
    case Channel::kNormal:
      return {"N.X", "N.Y", "N.Z"};
    case Channel::kDepth:
      return {"Z"};
    case Channel::kPosition:
      return {"P.X", "P.Y", "P.Z"};
  }
  return {};
}

/// From a pixel of a tile to one channel's values.
class ChannelValues {
 public:
  ChannelValues(const FrameRequest& request, const ChannelTile& pixels)
      : pixels_(pixels),
        mm_per_unit_(request.scene->millimetres_per_unit),
        eye_(request.camera.eye),
        axis_(glm::normalize(glm::dvec3(request.camera.target) - glm::dvec3(request.camera.eye))) {}

  glm::vec3 operator()(Channel channel, size_t pixel) const {
    switch (channel) {
      case Channel::kIrradiance:
        return glm::vec3(pixels_.irradiance[pixel]);
      case Channel::kRadiosity:
        return glm::vec3(pixels_.radiosity[pixel]);
      case Channel::kNormal:
        return glm::vec3(pixels_.normal[pixel]);
      case Channel::kDepth:
        if (pixels_.position_mm[pixel].w == 0) return glm::vec3(std::numeric_limits<float>::infinity());
        return glm::vec3(static_cast<float>(glm::dot(position(pixel) - eye_, axis_)));
      case Channel::kPosition:
        break;
    }
    return glm::vec3(position(pixel));
  }

 private:
  glm::dvec3 position(size_t pixel) const { return glm::dvec3(pixels_.position_mm[pixel]) / mm_per_unit_; }

  const ChannelTile& pixels_;
  const double mm_per_unit_;
  const glm::dvec3 eye_;
  const glm::dvec3 axis_;
};

}  // namespace

std::vector<std::string> channel_names(std::span<const Channel> channels) {
  std::vector<std::string> names = {"R", "G", "B", "A"};
  for (const Channel channel : channels) {
    for (const char* name : names_of(channel)) names.emplace_back(name);
  }
  return names;
}

ChannelNeeds needs_of(const FrameRequest& request) {
  ChannelNeeds needs;
  if (request.format != PixelFormat::kLinearFloat) return needs;
  for (const Channel channel : request.channels) {
    const bool light = channel == Channel::kIrradiance || channel == Channel::kRadiosity;
    (light ? needs.light : needs.surface) = true;
    if (channel == Channel::kIrradiance) needs.irradiance = true;
  }
  return needs;
}

void store_channels(const FrameRequest& request, const ChannelTile& pixels, const Tile& tile, base::ImageF& image) {
  const ChannelValues values(request, pixels);
  const size_t stride = image.channels.size();
  size_t first = kColourChannels;
  for (const Channel channel : request.channels) {
    const size_t count = names_of(channel).size();
    for (uint32_t row = 0; row < tile.height_px; ++row) {
      float* to = image.values.data() + first_pixel(image.width_px, image.height_px, tile, row) * stride + first;
      for (uint32_t x = 0; x < tile.width_px; ++x, to += stride) {
        const glm::vec3 value = values(channel, size_t{row} * tile.width_px + x);
        std::copy_n(&value.x, count, to);
      }
    }
    first += count;
  }
}

}  // namespace diaphane::render

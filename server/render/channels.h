// What a frame tells beside its colour.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "glm/vec4.hpp"
#include "render/frame.h"
#include "render/tiles.h"

namespace diaphane::render {

/// R G B A, then those of `channels` in their order, by the names that the field uses in EXR.
std::vector<std::string> channel_names(std::span<const Channel> channels);

/// What the extra channels of a frame need. `light`: E or B; `surface`: where a pixel is, and its normal.
struct ChannelNeeds {
  bool irradiance = false;
  bool light = false;
  bool surface = false;
};
ChannelNeeds needs_of(const FrameRequest& request);

/// A tile as it was drawn, rows bottom to top; a list is empty where no channel needs it.
struct ChannelTile {
  std::vector<glm::vec4> position_mm;  ///< a: above 0 where a surface is
  std::vector<glm::vec4> normal;       ///< xyz
  std::vector<glm::vec4> irradiance;   ///< rgb
  std::vector<glm::vec4> radiosity;    ///< rgb
  std::vector<glm::vec4> albedo;       ///< rgb; of textured frames
  std::vector<glm::vec4> coat;         ///< its normal, and the share of its alpha; of textured frames
};

/// Writes the request's channels of a tile to their place in `image`, which is the request's size and has all of
/// channel_names().
void store_channels(const FrameRequest& request, const ChannelTile& pixels, const Tile& tile, base::ImageF& image);

}  // namespace diaphane::render

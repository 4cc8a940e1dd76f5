// Reads back what the client's programs write, through the formats' own libraries.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace diaphane::testing_support {

/// What can be told of a file of frames.
struct Animation {
  int width_px = 0;
  int height_px = 0;
  std::vector<double> mean;  ///< of each frame: its mean byte, over colours alone, 0..255
};

/// By libwebpdemux. Nothing when it is not a WebP.
std::optional<Animation> decode_webp(const std::filesystem::path& path);

/// By libavformat and libavcodec; the mean is over luma alone. Nothing when it is not an MP4.
std::optional<Animation> decode_mp4(const std::filesystem::path& path);

}  // namespace diaphane::testing_support

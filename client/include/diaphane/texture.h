// Pictures for surfaces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace diaphane {

/// A picture as plain pixels, whatever it was read from or made by.
struct TextureData {
  std::string name;           ///< for messages only; may be empty
  uint32_t width_px = 0;      ///< 1..8192
  uint32_t height_px = 0;     ///< 1..8192
  std::vector<uint8_t> rgba;  ///< [height_px][width_px][4], from the upper edge down
  bool srgb = false;          ///< RGB is sRGB-coded; else linear
  bool clamp_u = false;       ///< beyond 0..1 the edge is held; else the picture repeats
  bool clamp_v = false;
};

/// Reads a PNG, JPEG or WebP file of at most 8192 pixels a side and 256 MiB, told apart by content. `srgb` is said of
/// the pixels, not found in the file: true for albedo, false for normals and roughness.
///
/// Errors, each one line that starts with the path: NOT_FOUND no such file; PERMISSION_DENIED it cannot be opened;
/// INVALID_ARGUMENT it is no such picture, or damaged; RESOURCE_EXHAUSTED it is too large. Thread-safe.
absl::StatusOr<TextureData> read_texture_file(const std::filesystem::path& path, bool srgb);

/// The same of a file's bytes, such as those of a frame.
///
/// Errors, each one line that starts with "picture": INVALID_ARGUMENT, RESOURCE_EXHAUSTED. Thread-safe.
absl::StatusOr<TextureData> decode_texture(std::string_view file, bool srgb);

}  // namespace diaphane

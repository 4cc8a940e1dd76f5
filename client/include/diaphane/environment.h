// Light from all around, from a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/values.h"

namespace diaphane {

/// A latitude-longitude map of radiance, linear RGB: rows from the upper edge (+y) down, the middle column −z, +x right
/// of it.
struct EnvironmentMap {
  uint32_t width_px = 0;      ///< 2..8192
  uint32_t height_px = 0;     ///< 1..4096
  std::vector<Rgb> radiance;  ///< [height_px][width_px], each 0..1e9
};

struct EnvironmentOptions {
  float rotation_deg = 0;  ///< about +y, counter-clockwise seen from above
  float intensity = 1;     ///< multiplies the map, 0..1e6
  bool occlusion = false;  ///< bodies hide from each other and themselves what of it is no lamp; costs 48 depth maps
};

/// Reads a Radiance picture (.hdr: RGBE, run lengths old or new, EXPOSURE divided out) or an OpenEXR image (R G B or Y;
/// what is below 0 is taken as 0), told apart by content. Sizes are checked before anything is allocated.
///
/// Errors, each one line "PATH: what, where, range": kNotFound no such file; kPermissionDenied it cannot be opened;
/// kInvalidArgument malformed; kResourceExhausted wider than 8192, higher than 4096, or a file over 1 GiB;
/// kUnimplemented a form that is named. Thread-safe.
absl::StatusOr<EnvironmentMap> read_environment_file(const std::filesystem::path& path);

}  // namespace diaphane

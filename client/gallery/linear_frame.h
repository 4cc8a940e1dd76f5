// A rendered EXR in memory: what figures are measured on. Plain values; functions are thread-safe.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/values.h"
#include "media/picture.h"

namespace diaphane::gallery {

/// Rows from the top; every vector has a value a pixel.
struct LinearFrame {
  int width_px = 0;
  int height_px = 0;
  std::vector<Rgb> radiance;     ///< W·mm⁻²·sr⁻¹; 0 where there is no surface
  std::vector<uint8_t> covered;  ///< 1 where the pixel's centre shows a surface
  std::vector<Vec3> position;    ///< of that surface, scene units
};

/// Errors: INVALID_ARGUMENT not an EXR, or one without colour, alpha and Channel::kPosition.
absl::StatusOr<LinearFrame> decode_exr(std::string_view file);

/// Rec. 709, of linear colour.
float luminance(const Rgb& colour);

/// Which surface points count.
using Region = std::function<bool(const Vec3& position)>;

/// Over the covered pixels of a region; 0 where it has none.
double mean_luminance(
    const LinearFrame& frame, const Region& region = [](const Vec3&) { return true; });

/// The exposure in stops at which the 98th percentile of the frames' luminance becomes a light grey; 0 for black ones.
double exposure_for(std::span<const LinearFrame* const> frames);

/// As the server encodes 8-bit frames: radiance times 2^exposure, clipped, sRGB.
media::Picture developed(const LinearFrame& frame, double exposure_ev);

}  // namespace diaphane::gallery

// Colours of vertices as files code them, into linear ones.
#pragma once

#include <limits>
#include <vector>

#include "diaphane/values.h"

namespace diaphane::readers {

enum class ColourCoding {
  kLinear,       ///< 0..1
  kSrgb,         ///< 0..1
  kSrgbOrBytes,  ///< sRGB: 0..255 where any component of the mesh is above 1, else 0..1
};

/// Stands for a vertex without a colour.
inline constexpr Rgb kNoColour = {std::numeric_limits<float>::quiet_NaN(), 0, 0};

/// The value that a coded one of 0..1 stands for (IEC 61966-2-1).
float linear_from_srgb(float coded);

/// Replaces coded colours by linear ones, cut to 0..1; kNoColour, or any other that is not a number, by white.
void make_linear(std::vector<Rgb>& colours, ColourCoding coding);

}  // namespace diaphane::readers

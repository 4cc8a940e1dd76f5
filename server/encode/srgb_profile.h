// The colour profile of what we encode.
#pragma once

#include <cstdint>
#include <vector>

namespace diaphane::encode {

/// sRGB (IEC 61966-2-1) as an ICC profile, version 4.3: primaries adapted to D50, a parametric curve. The same bytes
/// every time. Thread-safe.
const std::vector<uint8_t>& srgb_profile();

}  // namespace diaphane::encode

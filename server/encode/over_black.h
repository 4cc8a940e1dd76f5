// Pictures for formats without alpha.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace diaphane::encode {

/// `opaque` becomes `image` over black, four bytes a pixel, the last of which says nothing. Thread-safe.
void lay_over_black(const base::Image8& image, std::vector<uint8_t>& opaque);

}  // namespace diaphane::encode

#include "encode/over_black.h"

namespace diaphane::encode {

void lay_over_black(const base::Image8& image, std::vector<uint8_t>& opaque) {
  opaque.resize(image.rgba.size());
  const uint8_t* from = image.rgba.data();
  uint8_t* to = opaque.data();
  for (size_t i = 0; i < image.rgba.size(); i += 4) {
    const unsigned alpha = from[i + 3];
    // v·alpha/255, rounded.
    for (size_t c = 0; c < 3; ++c) {
      const unsigned product = from[i + c] * alpha + 128;
      to[i + c] = static_cast<uint8_t>((product + (product >> 8)) >> 8);
    }
  }
}

}  // namespace diaphane::encode

#include "render/srgb_table.h"

#include "render/develop.h"

namespace diaphane::render {

SrgbTable::SrgbTable() {
  for (size_t i = 0; i < pieces_.size(); ++i) {
    const auto edge = [&](size_t k) {
      return std::bit_cast<float>(std::bit_cast<uint32_t>(kFirst) + (static_cast<uint32_t>(k) << kDropped));
    };
    const float from = edge(i), to = edge(i + 1);
    const double start = encode_srgb(from);
    const double slope = (encode_srgb(to) - start) / (to - from);
    pieces_[i] = {static_cast<float>(255 * (start - slope * from) + 0.5), static_cast<float>(255 * slope)};
  }
}

}  // namespace diaphane::render

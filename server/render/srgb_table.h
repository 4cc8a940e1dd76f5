// sRGB bytes of linear values, quickly.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace diaphane::render {

/// The curve in straight pieces, 64 an octave: within a hundredth of a byte of encode_srgb(). Immutable.
class SrgbTable {
 public:
  SrgbTable();
  /// 0..255, rounded; what is not above 0 gives 0, what is above 1 gives 255.
  uint8_t byte_of(float linear) const {
    const float v = std::min(linear > 0 ? linear : 0.0f, 1.0f);
    if (v < kFirst) return static_cast<uint8_t>(255 * 12.92f * v + 0.5f);
    const Piece& piece = pieces_[(std::bit_cast<uint32_t>(v) - std::bit_cast<uint32_t>(kFirst)) >> kDropped];
    return static_cast<uint8_t>(piece.start + piece.slope * v);
  }

 private:
  struct Piece {
    float start, slope;  ///< of 255 times the curve, a half on top
  };
  static constexpr float kFirst = 0x1p-9f;  // the curve is straight up to 0.0031308
  static constexpr int kDropped = 17;       // bits of the mantissa
  std::array<Piece, 9 * 64 + 1> pieces_;
};

}  // namespace diaphane::render

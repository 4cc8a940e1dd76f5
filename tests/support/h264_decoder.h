// H.264 back to pictures, for tests.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

namespace diaphane::testing_support {

/// What a decoder shows of one access unit.
struct DecodedFrame {
  int width_px = 0;
  int height_px = 0;
  bool key_frame = false;
  double mean_luma = 0;  ///< 0..255
};

/// Decodes one access unit after the other, each to its frame at once; refuses what is damaged.
class H264Decoder {
 public:
  H264Decoder();
  ~H264Decoder();

  /// Nothing where the unit is damaged, refers to what was never there, or gives no frame of its own.
  std::optional<DecodedFrame> decode(std::string_view access_unit);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace diaphane::testing_support

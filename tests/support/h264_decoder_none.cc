#include "tests/support/h264_decoder.h"

namespace diaphane::testing_support {

class H264Decoder::Impl {};

H264Decoder::H264Decoder() = default;
H264Decoder::~H264Decoder() = default;
std::optional<DecodedFrame> H264Decoder::decode(std::string_view) { return std::nullopt; }

}  // namespace diaphane::testing_support

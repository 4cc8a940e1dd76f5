#include "encode/h264.h"

namespace diaphane::encode {

class H264Encoder::Impl {};

H264Encoder::H264Encoder() = default;
H264Encoder::~H264Encoder() = default;

absl::StatusOr<H264Frame> H264Encoder::encode(const base::Image8&, const H264Options&) {
  return absl::UnimplementedError("H.264: this server was built without libavcodec");
}

const std::string& h264_encoder() {
  static const std::string none;
  return none;
}

}  // namespace diaphane::encode

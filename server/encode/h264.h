// Pictures to H.264, one behind the other.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "base/image.h"

namespace diaphane::encode {

/// What one frame is encoded with.
struct H264Options {
  uint32_t bits_per_second = 4'000'000;  ///< at kVideoRate frames a second; 10,000..1e9
  bool key_frame = false;                ///< decodable by itself, whatever came before
};

/// A stream says no rate of its frames; bits are shared out as if so many came.
inline constexpr int kVideoRate = 30;

struct H264Frame {
  std::string bytes;  ///< one access unit, Annex B, with its parameter sets where it is a key frame
  bool key_frame = false;
};

/// A stream of frames, each of which comes out as it goes in, laid over black: no frame is held back, none refers to a
/// later one. Another size begins a new stream with a key frame; another bitrate holds from the next frame on. By the
/// first of kH264Encoders that opens. One thread at a time.
class H264Encoder {
 public:
  H264Encoder();
  ~H264Encoder();

  /// Errors: UNIMPLEMENTED built without libavcodec, or it has no encoder that opens; INTERNAL what the encoder says.
  absl::StatusOr<H264Frame> encode(const base::Image8& image, const H264Options& options);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// libavcodec's names, the most wanted first: a GPU's, then x264, then Cisco's.
inline constexpr const char* kH264Encoders[] = {"h264_nvenc", "libx264", "libopenh264"};

/// The encoder's name, or empty where there is none. Opens one the first time. Thread-safe.
const std::string& h264_encoder();

}  // namespace diaphane::encode

// Images to bytes, in memory.
#pragma once

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "base/image.h"

namespace diaphane::encode {

enum class ImageFormat {
  kPng,   ///< of an Image8: RGBA, lossless; says sRGB
  kJpeg,  ///< of an Image8: RGB, laid over black; carries srgb_profile()
  kExr    ///< of an ImageF: its channels, 32-bit float
};

struct Encoding {
  ImageFormat format = ImageFormat::kPng;
  int jpeg_quality = 90;  ///< 1..100
};

/// "image/png", "image/jpeg" or "image/x-exr".
std::string_view content_type(ImageFormat format);

/// The same image gives the same bytes: no time, host or version is written. Errors: INTERNAL from the encoder.
/// Thread-safe.
absl::StatusOr<std::string> encode_png(const base::Image8& image);
absl::StatusOr<std::string> encode_jpeg(const base::Image8& image, int quality);
absl::StatusOr<std::string> encode_exr(const base::ImageF& image);

}  // namespace diaphane::encode

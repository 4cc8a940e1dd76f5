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
  kExr,   ///< of an ImageF: its channels, 32-bit float
  kWebp,  ///< of an Image8: RGBA, lossy
  kH264   ///< of Image8s, one after the other: see h264.h
};

struct Encoding {
  ImageFormat format = ImageFormat::kPng;
  int quality = 90;                      ///< of JPEG and WebP, 1..100
  uint32_t bits_per_second = 4'000'000;  ///< of H.264
};

/// "image/png", "image/jpeg", "image/x-exr", "image/webp" or "video/h264".
std::string_view content_type(ImageFormat format);

/// The same image gives the same bytes: no time, host or version is written. Errors: INTERNAL from the encoder.
/// Thread-safe.
absl::StatusOr<std::string> encode_png(const base::Image8& image);
absl::StatusOr<std::string> encode_jpeg(const base::Image8& image, int quality);
absl::StatusOr<std::string> encode_webp(const base::Image8& image, int quality);
absl::StatusOr<std::string> encode_exr(const base::ImageF& image);

}  // namespace diaphane::encode

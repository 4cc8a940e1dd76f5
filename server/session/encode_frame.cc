#include "session/encode_frame.h"

#include <utility>

namespace diaphane::session {
namespace {

absl::StatusOr<std::string> encode_pixels(const render::Frame& frame, const encode::Encoding& encoding) {
  if (const auto* image = std::get_if<base::Image8>(&frame.image)) {
    if (encoding.format == encode::ImageFormat::kPng) return encode::encode_png(*image);
    if (encoding.format == encode::ImageFormat::kJpeg) return encode::encode_jpeg(*image, encoding.quality);
    if (encoding.format == encode::ImageFormat::kWebp) return encode::encode_webp(*image, encoding.quality);
  } else if (encoding.format == encode::ImageFormat::kExr) {
    return encode::encode_exr(std::get<base::ImageF>(frame.image));
  }
  return absl::InternalError("the renderer answered with pixels of the wrong kind");
}

}  // namespace

absl::StatusOr<EncodedFrame> encode_frame(render::Frame& frame, const encode::Encoding& encoding) {
  const absl::Time start = absl::Now();
  EncodedFrame encoded;
  const bool is_video = encoding.format == encode::ImageFormat::kH264;
  if (!is_video) {
    absl::StatusOr<std::string> bytes = encode_pixels(frame, encoding);
    if (!bytes.ok()) return bytes.status();
    encoded.bytes = *std::move(bytes);
  }
  encoded.content_type = encode::content_type(encoding.format);
  std::visit(
      [&](const auto& image) {
        encoded.width_px = image.width_px;
        encoded.height_px = image.height_px;
      },
      frame.image);
  encoded.scene_revision = frame.scene_revision;
  encoded.stages = frame.stages;
  if (is_video) {
    encoded.pixels = std::get<base::Image8>(std::move(frame.image));
  } else {
    encoded.stages.push_back({"encode", milliseconds_since(start), true});
  }
  encoded.path = frame.path;
  encoded.exposure_ev = frame.exposure_ev;
  return encoded;
}

double milliseconds_since(absl::Time start) { return absl::ToDoubleMilliseconds(absl::Now() - start); }

}  // namespace diaphane::session

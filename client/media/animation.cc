#include "media/animation.h"

#include "fmt/format.h"

namespace diaphane::media {
namespace {

constexpr int kShortest_px = 16;
constexpr int kLongest_px = 8192;
constexpr double kFastest = 120;

absl::Status check_side(const char* name, int pixels) {
  if (pixels >= kShortest_px && pixels <= kLongest_px) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("{}: must be {}..{}, got {}", name, kShortest_px, kLongest_px, pixels));
}

}  // namespace

absl::Status check_animation_options(const AnimationOptions& options) {
  if (absl::Status status = check_side("width_px", options.width_px); !status.ok()) return status;
  if (absl::Status status = check_side("height_px", options.height_px); !status.ok()) return status;
  if (!(options.frames_per_second > 0 && options.frames_per_second <= kFastest)) {
    return absl::InvalidArgumentError(
        fmt::format("frames_per_second: must be above 0, up to {}, got {}", kFastest, options.frames_per_second));
  }
  if (options.quality < 0 || options.quality > 100) {
    return absl::InvalidArgumentError(fmt::format("quality: must be 0..100, got {}", options.quality));
  }
  return absl::OkStatus();
}

absl::Status check_frame(const Picture& frame, const AnimationOptions& options) {
  if (frame.width_px == options.width_px && frame.height_px == options.height_px) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("frame: must be {}x{}, got {}x{}", options.width_px, options.height_px,
                                                frame.width_px, frame.height_px));
}

}  // namespace diaphane::media

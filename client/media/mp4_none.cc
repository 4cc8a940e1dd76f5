#include "media/animation.h"

namespace diaphane::media {

absl::StatusOr<std::unique_ptr<AnimationWriter>> open_mp4(const std::filesystem::path&, const AnimationOptions&) {
  return absl::UnimplementedError("built without libavcodec: no MP4");
}

}  // namespace diaphane::media

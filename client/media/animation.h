// Frames in order, as one animated file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "media/picture.h"

namespace diaphane::media {

struct AnimationOptions {
  int width_px = 0;               ///< 16..8192; what is odd in an MP4 is cut by one
  int height_px = 0;              ///< 16..8192
  double frames_per_second = 12;  ///< above 0, up to 120
  int quality = 85;               ///< 0..100, where the encoder asks for one
};

/// One file in the making. It is there, whole, once finish() returned OK; dropped before, it leaves nothing. One thread
/// at a time.
class AnimationWriter {
 public:
  virtual ~AnimationWriter() = default;

  /// The next frame, of the size that the options say; it is shown over black.
  ///
  /// Errors: INVALID_ARGUMENT another size; INTERNAL what the encoder says.
  virtual absl::Status add(const Picture& frame) = 0;

  /// Errors: FAILED_PRECONDITION no frame; DATA_LOSS the file cannot be written; INTERNAL what the encoder says.
  virtual absl::Status finish() = 0;

  /// Which encoder makes it.
  virtual std::string encoder() const = 0;
};

/// An animated WebP, which repeats for ever. Frames that are the same as the one before are kept as a longer one.
///
/// Errors: INVALID_ARGUMENT names the option and its range.
absl::StatusOr<std::unique_ptr<AnimationWriter>> open_webp(const std::filesystem::path& path,
                                                           const AnimationOptions& options);

/// An MP4, in the first of kMp4Encoders that this machine's libavcodec has and that opens.
///
/// Errors: as for open_webp; kUnimplemented built without libavcodec; UNAVAILABLE it has none of the encoders.
absl::StatusOr<std::unique_ptr<AnimationWriter>> open_mp4(const std::filesystem::path& path,
                                                          const AnimationOptions& options);

/// libavcodec's names, the most wanted first: what browsers play, then what every libavcodec has.
inline constexpr const char* kMp4Encoders[] = {"libx264", "libopenh264", "libvpx-vp9", "libsvtav1", "mpeg4"};

/// What is wrong with the options, if anything.
absl::Status check_animation_options(const AnimationOptions& options);

/// What is wrong with a frame for them, if anything.
absl::Status check_frame(const Picture& frame, const AnimationOptions& options);

}  // namespace diaphane::media

// Frames against a frame that is right.
#pragma once

#include "gallery/linear_frame.h"
#include "media/picture.h"

namespace diaphane::gallery {

/// Over the pixels that both frames cover, in per cent of the right frame's mean in that channel.
struct Errors {
  Rgb rms_percent;
  double percentile_99_9 = 0;  ///< of the largest channel's |difference|
  double largest = 0;
};

/// The frames have one size and camera.
Errors errors_of(const LinearFrame& frame, const LinearFrame& right);

/// The largest channel's |difference| in per cent of its mean, in false colour from 0 to `full_percent`.
media::Picture error_picture(const LinearFrame& frame, const LinearFrame& right, double full_percent);

/// The false colours from left to right, 0 to full.
media::Picture colour_scale(int width_px, int height_px);

}  // namespace diaphane::gallery

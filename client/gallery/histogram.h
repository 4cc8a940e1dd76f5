// How bright the pixels of a picture are (the paper's Fig. 6, after Fleming, Jensen, Bülthoff 2004).
#pragma once

#include <array>

#include "gallery/linear_frame.h"
#include "media/picture.h"

namespace diaphane::gallery {

/// Shares of the body's pixels by luma, 0..255 of the 8-bit picture in as many equal bins; they sum to 1.
using Histogram = std::array<double, 64>;

/// Of `frame` developed at that exposure; the background does not count.
Histogram luma_histogram(const LinearFrame& frame, double exposure_ev);

/// How far the one must be shifted to become the other, on average: the earth mover's distance, in levels of 255.
double levels_apart(const Histogram& a, const Histogram& b);

/// Bars from dark to bright, the highest as high as `highest` of the picture.
media::Picture drawn(const Histogram& histogram, double highest, int width_px, int height_px);

}  // namespace diaphane::gallery

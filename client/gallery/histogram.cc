#include "gallery/histogram.h"

#include <algorithm>
#include <cmath>

namespace diaphane::gallery {
namespace {

constexpr double kLevelsPerBin = 256.0 / std::tuple_size_v<Histogram>;
constexpr media::Colour kBar{205, 170, 110};

}  // namespace

Histogram luma_histogram(const LinearFrame& frame, double exposure_ev) {
  const media::Picture picture = developed(frame, exposure_ev);
  Histogram histogram{};
  double count = 0;
  for (size_t i = 0; i < frame.covered.size(); ++i) {
    if (frame.covered[i] == 0) continue;
    const uint8_t* p = &picture.rgba[4 * i];
    const double luma = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
    ++histogram[std::min(histogram.size() - 1, static_cast<size_t>(luma / kLevelsPerBin))];
    ++count;
  }
  for (double& share : histogram) share /= std::max(count, 1.0);
  return histogram;
}

double levels_apart(const Histogram& a, const Histogram& b) {
  double sum = 0;
  double carried = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    carried += a[i] - b[i];
    sum += std::abs(carried);
  }
  return sum * kLevelsPerBin;
}

media::Picture drawn(const Histogram& histogram, double highest, int width_px, int height_px) {
  media::Picture picture = media::filled(width_px, height_px, media::kBackground);
  for (int x = 0; x < width_px; ++x) {
    const size_t bin = static_cast<size_t>(x) * histogram.size() / static_cast<size_t>(width_px);
    const double share = highest > 0 ? std::min(1.0, histogram[bin] / highest) : 0;
    const int bar = static_cast<int>(std::lround(share * (height_px - 1)));
    media::draw_over(media::filled(1, bar, kBar), x, height_px - bar, picture);
  }
  return picture;
}

}  // namespace diaphane::gallery

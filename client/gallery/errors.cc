#include "gallery/errors.h"

#include <algorithm>
#include <cmath>

namespace diaphane::gallery {
namespace {

// Dark to bright in luma, too, so that it reads in grey.
constexpr media::Colour kColours[] = {{8, 6, 26},    {60, 18, 110},  {130, 30, 120}, {190, 50, 90},
                                      {232, 95, 50}, {250, 165, 40}, {250, 245, 170}};

media::Colour false_colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (std::size(kColours) - 1);
  const size_t below = std::min(static_cast<size_t>(at), std::size(kColours) - 2);
  const double t = at - static_cast<double>(below);
  const auto mix = [t](uint8_t a, uint8_t b) { return static_cast<uint8_t>(std::lround(a + t * (b - a))); };
  const media::Colour& a = kColours[below];
  const media::Colour& b = kColours[below + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

bool counts(const LinearFrame& frame, const LinearFrame& right, size_t pixel) {
  return frame.covered[pixel] != 0 && right.covered[pixel] != 0;
}

Rgb mean_of(const LinearFrame& right, const LinearFrame& frame) {
  double sum[3] = {};
  double count = 0;
  for (size_t i = 0; i < right.radiance.size(); ++i) {
    if (!counts(frame, right, i)) continue;
    sum[0] += right.radiance[i].r;
    sum[1] += right.radiance[i].g;
    sum[2] += right.radiance[i].b;
    ++count;
  }
  const auto mean = [&](double s) { return static_cast<float>(std::max(s / std::max(count, 1.0), 1e-30)); };
  return {mean(sum[0]), mean(sum[1]), mean(sum[2])};
}

// Of the mean, signed.
Rgb difference(const Rgb& a, const Rgb& b, const Rgb& mean) {
  return {(a.r - b.r) / mean.r, (a.g - b.g) / mean.g, (a.b - b.b) / mean.b};
}

float largest_of(const Rgb& d) { return std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)}); }

}  // namespace

Errors errors_of(const LinearFrame& frame, const LinearFrame& right) {
  const Rgb mean = mean_of(right, frame);
  double squares[3] = {};
  std::vector<double> largest;
  for (size_t i = 0; i < right.radiance.size(); ++i) {
    if (!counts(frame, right, i)) continue;
    const Rgb d = difference(frame.radiance[i], right.radiance[i], mean);
    squares[0] += static_cast<double>(d.r) * d.r;
    squares[1] += static_cast<double>(d.g) * d.g;
    squares[2] += static_cast<double>(d.b) * d.b;
    largest.push_back(100 * largest_of(d));
  }
  if (largest.empty()) return {};
  std::sort(largest.begin(), largest.end());
  const auto rms = [&](double sum) {
    return static_cast<float>(100 * std::sqrt(sum / static_cast<double>(largest.size())));
  };
  return {{rms(squares[0]), rms(squares[1]), rms(squares[2])},
          largest[static_cast<size_t>(0.999 * static_cast<double>(largest.size() - 1))],
          largest.back()};
}

media::Picture error_picture(const LinearFrame& frame, const LinearFrame& right, double full_percent) {
  const Rgb mean = mean_of(right, frame);
  media::Picture picture = media::filled(right.width_px, right.height_px, media::kBackground);
  for (size_t i = 0; i < right.radiance.size(); ++i) {
    if (!counts(frame, right, i)) continue;
    const Rgb d = difference(frame.radiance[i], right.radiance[i], mean);
    const media::Colour colour = false_colour(100 * largest_of(d) / full_percent);
    picture.rgba[4 * i] = colour.r;
    picture.rgba[4 * i + 1] = colour.g;
    picture.rgba[4 * i + 2] = colour.b;
  }
  return picture;
}

media::Picture colour_scale(int width_px, int height_px) {
  media::Picture picture = media::filled(width_px, height_px, {});
  for (int x = 0; x < width_px; ++x) {
    const media::Colour colour = false_colour(static_cast<double>(x) / (width_px - 1));
    media::draw_over(media::filled(1, height_px, colour), x, 0, picture);
  }
  return picture;
}

}  // namespace diaphane::gallery

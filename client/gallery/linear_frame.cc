#include "gallery/linear_frame.h"

#include <algorithm>
#include <cmath>

#include "OpenImageIO/filesystem.h"
#include "OpenImageIO/imageio.h"
#include "fmt/format.h"

namespace diaphane::gallery {
namespace {

constexpr double kBright = 0.98;    // the share of pixels that exposure_for keeps below ...
constexpr double kLightGrey = 0.7;  // ... this much of white, linear
constexpr const char* kChannels[] = {"R", "G", "B", "A", "P.X", "P.Y", "P.Z"};

uint8_t srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255 * encoded));
}

}  // namespace

absl::StatusOr<LinearFrame> decode_exr(std::string_view file) {
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(file.data()), file.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
  const auto input = OIIO::ImageInput::open("memory.exr", &wanted);
  if (input == nullptr) return absl::InvalidArgumentError(fmt::format("EXR: {}", OIIO::geterror()));
  const OIIO::ImageSpec spec = input->spec();
  int index[std::size(kChannels)];
  for (size_t i = 0; i < std::size(kChannels); ++i) {
    index[i] = spec.channelindex(kChannels[i]);
    if (index[i] < 0) return absl::InvalidArgumentError(fmt::format("EXR: has no channel {}", kChannels[i]));
  }
  const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
  std::vector<float> values(pixels * static_cast<size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) {
    return absl::InvalidArgumentError(fmt::format("EXR: {}", input->geterror()));
  }
  LinearFrame frame{spec.width, spec.height, {}, {}, {}};
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    const float* v = &values[pixel * static_cast<size_t>(spec.nchannels)];
    frame.radiance.push_back({v[index[0]], v[index[1]], v[index[2]]});
    frame.covered.push_back(v[index[3]] > 0.5f ? 1 : 0);
    frame.position.push_back({v[index[4]], v[index[5]], v[index[6]]});
  }
  return frame;
}

float luminance(const Rgb& colour) { return 0.2126f * colour.r + 0.7152f * colour.g + 0.0722f * colour.b; }

double mean_luminance(const LinearFrame& frame, const Region& region) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < frame.radiance.size(); ++i) {
    if (frame.covered[i] == 0 || !region(frame.position[i])) continue;
    sum += luminance(frame.radiance[i]);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double exposure_for(std::span<const LinearFrame* const> frames) {
  std::vector<float> values;
  for (const LinearFrame* frame : frames) {
    for (size_t i = 0; i < frame->radiance.size(); ++i) {
      if (frame->covered[i] != 0) values.push_back(luminance(frame->radiance[i]));
    }
  }
  if (values.empty()) return 0;
  const auto bright = values.begin() + static_cast<std::ptrdiff_t>(kBright * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), bright, values.end());
  return *bright > 0 ? std::log2(kLightGrey / *bright) : 0;
}

media::Picture developed(const LinearFrame& frame, double exposure_ev) {
  media::Picture picture = media::filled(frame.width_px, frame.height_px, media::kBackground);
  const double scale = std::exp2(exposure_ev);
  for (size_t i = 0; i < frame.radiance.size(); ++i) {
    if (frame.covered[i] == 0) continue;
    const Rgb& colour = frame.radiance[i];
    picture.rgba[4 * i] = srgb(scale * colour.r);
    picture.rgba[4 * i + 1] = srgb(scale * colour.g);
    picture.rgba[4 * i + 2] = srgb(scale * colour.b);
  }
  return picture;
}

}  // namespace diaphane::gallery

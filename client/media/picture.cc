#include "media/picture.h"

#include <algorithm>

#include "OpenImageIO/filesystem.h"
#include "OpenImageIO/imagebuf.h"
#include "OpenImageIO/imagebufalgo.h"
#include "fmt/format.h"

namespace diaphane::media {
namespace {

constexpr int kLongestSide_px = 8192;

OIIO::ImageSpec spec_of(const Picture& picture) {
  OIIO::ImageSpec spec(picture.width_px, picture.height_px, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return spec;
}

size_t offset_of(const Picture& picture, int x, int y) {
  return 4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width_px) + static_cast<size_t>(x));
}

}  // namespace

Picture filled(int width_px, int height_px, const Colour& colour) {
  Picture picture{width_px, height_px, {}};
  picture.rgba.resize(4 * static_cast<size_t>(width_px) * static_cast<size_t>(height_px));
  for (size_t i = 0; i < picture.rgba.size(); i += 4) {
    picture.rgba[i] = colour.r;
    picture.rgba[i + 1] = colour.g;
    picture.rgba[i + 2] = colour.b;
    picture.rgba[i + 3] = 255;
  }
  return picture;
}

absl::StatusOr<Picture> decode_picture(std::string_view file) {
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(file.data()), file.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const bool png = file.substr(0, 4) == "\x89PNG";
  const auto input = OIIO::ImageInput::open(png ? "memory.png" : "memory.jpg", &wanted);
  if (input == nullptr) return absl::InvalidArgumentError(fmt::format("picture: {}", OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width > kLongestSide_px || spec.height > kLongestSide_px || spec.nchannels < 3) {
    return absl::InvalidArgumentError(fmt::format("picture: must have at most {0}x{0} pixels in colour, got {1}x{2}",
                                                  kLongestSide_px, spec.width, spec.height));
  }
  Picture picture = filled(spec.width, spec.height, {});
  if (!input->read_image(0, 0, 0, std::min(4, spec.nchannels), OIIO::TypeDesc::UINT8, picture.rgba.data(), 4)) {
    return absl::InvalidArgumentError(fmt::format("picture: {}", input->geterror()));
  }
  return picture;
}

absl::Status write_png(const Picture& picture, const std::filesystem::path& path) {
  const auto failed = [&](const std::string& why) {
    return absl::DataLossError(fmt::format("{}: cannot be written: {}", path.string(), why));
  };
  const auto output = OIIO::ImageOutput::create(path.string());
  if (output == nullptr) return failed(OIIO::geterror());
  if (!output->open(path.string(), spec_of(picture)) ||
      !output->write_image(OIIO::TypeDesc::UINT8, picture.rgba.data()) || !output->close()) {
    return failed(output->geterror());
  }
  return absl::OkStatus();
}

void draw_over(const Picture& picture, int x, int y, Picture& under) {
  const int first_column = std::max(0, -x);
  const int last_column = std::min(picture.width_px, under.width_px - x);
  for (int row = std::max(0, -y); row < std::min(picture.height_px, under.height_px - y); ++row) {
    for (int column = first_column; column < last_column; ++column) {
      const uint8_t* from = &picture.rgba[offset_of(picture, column, row)];
      uint8_t* to = &under.rgba[offset_of(under, x + column, y + row)];
      const unsigned alpha = from[3];
      for (int c = 0; c < 3; ++c) to[c] = static_cast<uint8_t>((from[c] * alpha + to[c] * (255 - alpha) + 127) / 255);
      to[3] = static_cast<uint8_t>(alpha + (to[3] * (255 - alpha) + 127) / 255);
    }
  }
}

Picture over(const Picture& picture, const Colour& background) {
  Picture under = filled(picture.width_px, picture.height_px, background);
  draw_over(picture, 0, 0, under);
  return under;
}

Picture beside(std::span<const Picture> pictures) {
  int width = 0;
  int height = 0;
  for (const Picture& picture : pictures) {
    width += picture.width_px;
    height = std::max(height, picture.height_px);
  }
  Picture all = filled(width, height, kBackground);
  int x = 0;
  for (const Picture& picture : pictures) {
    draw_over(picture, x, 0, all);
    x += picture.width_px;
  }
  return all;
}

Picture shrunk(const Picture& picture, int longest_px) {
  const int longest = std::max(picture.width_px, picture.height_px);
  if (longest <= longest_px) return picture;
  const double scale = static_cast<double>(longest_px) / longest;
  Picture small = filled(std::max(1, static_cast<int>(picture.width_px * scale)),
                         std::max(1, static_cast<int>(picture.height_px * scale)), {});
  const OIIO::ImageBuf given(spec_of(picture), const_cast<uint8_t*>(picture.rgba.data()));
  // Colours of pixels without cover must not bleed in.
  const OIIO::ImageBuf covered = OIIO::ImageBufAlgo::premult(given);
  OIIO::ImageBuf result = OIIO::ImageBufAlgo::resize(covered, "", 0, {0, small.width_px, 0, small.height_px});
  result = OIIO::ImageBufAlgo::unpremult(result);
  result.get_pixels(result.roi(), OIIO::TypeDesc::UINT8, small.rgba.data());
  return small;
}

}  // namespace diaphane::media

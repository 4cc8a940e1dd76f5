#include <algorithm>

#include "OpenImageIO/filesystem.h"
#include "OpenImageIO/imagebuf.h"
#include "OpenImageIO/imagebufalgo.h"
#include "fmt/format.h"
#include "media/picture.h"

namespace diaphane::media {
namespace {

constexpr int kLongestSide_px = 8192;

OIIO::ImageSpec spec_of(const Picture& picture) {
  OIIO::ImageSpec spec(picture.width_px, picture.height_px, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return spec;
}

}  // namespace

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

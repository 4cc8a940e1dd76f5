#include <memory>
#include <vector>

#include "encode/encode.h"
#include "encode/over_black.h"
#include "encode/srgb_profile.h"
#include "fmt/format.h"
#include "turbojpeg.h"

namespace diaphane::encode {
namespace {

struct Destroy {
  void operator()(void* compressor) const { tjDestroy(compressor); }
};

/// The marker of an ICC profile in one piece (ICC.1, annex B.4).
std::string profile_segment() {
  const std::vector<uint8_t>& profile = srgb_profile();
  constexpr std::string_view kName("ICC_PROFILE\0\x01\x01", 14);
  const size_t length = 2 + kName.size() + profile.size();
  std::string segment{'\xff', '\xe2', static_cast<char>(length >> 8), static_cast<char>(length & 0xff)};
  segment += kName;
  segment.append(profile.begin(), profile.end());
  return segment;
}

}  // namespace

absl::StatusOr<std::string> encode_jpeg(const base::Image8& image, int quality) {
  const auto width_px = static_cast<int>(image.width_px), height_px = static_cast<int>(image.height_px);
  const std::unique_ptr<void, Destroy> compressor(tjInitCompress());
  if (compressor == nullptr) return absl::InternalError("encoding JPEG: no compressor");
  std::vector<unsigned char> bytes(tjBufSize(width_px, height_px, TJSAMP_420));
  unsigned char* at = bytes.data();
  auto size = static_cast<unsigned long>(bytes.size());
  std::vector<uint8_t> opaque;
  lay_over_black(image, opaque);
  if (tjCompress2(compressor.get(), opaque.data(), width_px, 0, height_px, TJPF_RGBX, &at, &size, TJSAMP_420, quality,
                  TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0) {
    return absl::InternalError(fmt::format("encoding JPEG: {}", tjGetErrorStr2(compressor.get())));
  }
  // Behind the start of the image (two bytes) and JFIF's own segment.
  const size_t before = 4 + (size_t{at[4]} << 8 | at[5]);
  static const std::string profile = profile_segment();
  std::string file;
  file.reserve(size + profile.size());
  file.append(at, at + before).append(profile).append(at + before, at + size);
  return file;
}

}  // namespace diaphane::encode

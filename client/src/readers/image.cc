#include "readers/image.h"

#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include <filesystem>
#include <memory>

#include "fmt/format.h"
#include "readers/file.h"

namespace diaphane::readers {
namespace {

constexpr uint64_t kLargestSide_px = 8192;

const unsigned char* data_of(std::string_view bytes) { return reinterpret_cast<const unsigned char*>(bytes.data()); }

/// Room for the pixels of a picture.
absl::StatusOr<TextureData> allocate(uint64_t width_px, uint64_t height_px, uint64_t max_pixels, const Source& source) {
  if (width_px == 0 || height_px == 0) return source.malformed("is a picture without pixels");
  const uint64_t largest = std::max(width_px, height_px);
  if (largest > kLargestSide_px) return source.over_limit("pixels a side", largest, kLargestSide_px);
  if (width_px * height_px > max_pixels) return source.over_limit("pixels", width_px * height_px, max_pixels);
  TextureData texture;
  texture.width_px = static_cast<uint32_t>(width_px);
  texture.height_px = static_cast<uint32_t>(height_px);
  texture.rgba.resize(4 * width_px * height_px);
  return texture;
}

absl::StatusOr<TextureData> decode_png(std::string_view bytes, uint64_t max_pixels, const Source& source) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&image, &png_image_free);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
    return source.malformed(fmt::format("is no PNG: {}", image.message));
  }
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // else it takes 16 bits for linear ones
  absl::StatusOr<TextureData> texture = allocate(image.width, image.height, max_pixels, source);
  if (!texture.ok()) return texture;
  if (png_image_finish_read(&image, nullptr, texture->rgba.data(), 0, nullptr) == 0) {
    return source.malformed(fmt::format("is a damaged PNG: {}", image.message));
  }
  return texture;
}

absl::StatusOr<TextureData> decode_jpeg(std::string_view bytes, uint64_t max_pixels, const Source& source) {
  const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), &tjDestroy);
  if (decoder == nullptr) return absl::ResourceExhaustedError("no memory for a JPEG decoder");
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  const auto size = static_cast<unsigned long>(bytes.size());
  if (tjDecompressHeader3(decoder.get(), data_of(bytes), size, &width, &height, &subsampling, &colorspace) != 0) {
    return source.malformed(fmt::format("is no JPEG: {}", tjGetErrorStr2(decoder.get())));
  }
  absl::StatusOr<TextureData> texture =
      allocate(static_cast<uint64_t>(width), static_cast<uint64_t>(height), max_pixels, source);
  if (!texture.ok()) return texture;
  const int failed = tjDecompress2(decoder.get(), data_of(bytes), size, texture->rgba.data(), width, 0, height,
                                   TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING);
  if (failed != 0) return source.malformed(fmt::format("is a damaged JPEG: {}", tjGetErrorStr2(decoder.get())));
  return texture;
}

absl::StatusOr<TextureData> decode_webp(std::string_view bytes, uint64_t max_pixels, const Source& source) {
  int width = 0, height = 0;
  if (WebPGetInfo(data_of(bytes), bytes.size(), &width, &height) == 0) return source.malformed("is no WebP");
  absl::StatusOr<TextureData> texture =
      allocate(static_cast<uint64_t>(width), static_cast<uint64_t>(height), max_pixels, source);
  if (!texture.ok()) return texture;
  const uint8_t* decoded =
      WebPDecodeRGBAInto(data_of(bytes), bytes.size(), texture->rgba.data(), texture->rgba.size(), 4 * width);
  if (decoded == nullptr) return source.malformed("is a damaged WebP");
  return texture;
}

}  // namespace

absl::StatusOr<TextureData> decode_image(std::string_view bytes, uint64_t max_pixels, const Source& source) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes, max_pixels, source);
  if (bytes.starts_with("\xff\xd8\xff")) return decode_jpeg(bytes, max_pixels, source);
  if (bytes.starts_with("RIFF") && bytes.find("WEBP", 8) == 8) return decode_webp(bytes, max_pixels, source);
  return source.malformed("is neither PNG nor JPEG nor WebP");
}

}  // namespace diaphane::readers

namespace diaphane {

absl::StatusOr<TextureData> read_texture_file(const std::filesystem::path& path, bool srgb) {
  const readers::Source source{path.string(), {}, {}};
  const absl::StatusOr<std::string> bytes = readers::read_whole_file(path, uint64_t{256} << 20, source);
  if (!bytes.ok()) return bytes.status();
  absl::StatusOr<TextureData> texture = readers::decode_image(*bytes, source.limits.max_texture_pixels, source);
  if (!texture.ok()) return texture;
  texture->name = path.filename().string();
  texture->srgb = srgb;
  return texture;
}

absl::StatusOr<TextureData> decode_texture(std::string_view file, bool srgb) {
  const readers::Source source{"picture", {}, {}};
  absl::StatusOr<TextureData> texture = readers::decode_image(file, source.limits.max_texture_pixels, source);
  if (texture.ok()) texture->srgb = srgb;
  return texture;
}

}  // namespace diaphane

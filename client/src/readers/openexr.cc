// OpenEXR images, by its library.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "fmt/format.h"
#include "readers/environment.h"

namespace diaphane::readers {
namespace {

/// A file in memory. Errors are exceptions, as the library has them.
class MemoryFile final : public Imf::IStream {
 public:
  explicit MemoryFile(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}

  bool read(char to[], int count) override {
    if (count < 0 || static_cast<uint64_t>(count) > bytes_.size() - at_) throw std::runtime_error("ends too soon");
    std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
    at_ += static_cast<size_t>(count);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("points past its end");
    at_ = position;
  }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
};

absl::StatusOr<EnvironmentMap> decode(std::string_view bytes, const Source& source) {
  MemoryFile stream(bytes);
  Imf::InputFile file(stream);
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  if (absl::Status size = check_map_size(width, height, source); !size.ok()) return size;
  const Imf::ChannelList& channels = file.header().channels();
  const bool coloured = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
  if (!coloured && !channels.findChannel("Y")) return source.unsupported("an image without R, G, B or Y", "header");
  if (!coloured && channels.findChannel("RY")) return source.unsupported("luminance with chroma", "header");

  EnvironmentMap map{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  map.radiance.resize(static_cast<size_t>(width * height));
  const size_t pixel_bytes = sizeof(Rgb), row_bytes = pixel_bytes * map.width_px;
  // Where pixel 0, 0 would be: the window may begin elsewhere.
  char* const origin = reinterpret_cast<char*>(map.radiance.data()) -
                       window.min.x * static_cast<ptrdiff_t>(pixel_bytes) -
                       window.min.y * static_cast<ptrdiff_t>(row_bytes);
  Imf::FrameBuffer target;
  const auto insert = [&](const char* name, size_t offset) {
    target.insert(name, Imf::Slice(Imf::FLOAT, origin + offset, pixel_bytes, row_bytes));
  };
  insert(coloured ? "R" : "Y", offsetof(Rgb, r));
  if (coloured) {
    insert("G", offsetof(Rgb, g));
    insert("B", offsetof(Rgb, b));
  }
  file.setFrameBuffer(target);
  file.readPixels(window.min.y, window.max.y);
  for (size_t i = 0; i < map.radiance.size(); ++i) {
    Rgb& pixel = map.radiance[i];
    if (!coloured) pixel.g = pixel.b = pixel.r;
    for (float* const value : {&pixel.r, &pixel.g, &pixel.b}) {
      if (!std::isfinite(*value)) {
        return source.malformed("a pixel that is not finite",
                                fmt::format("row {}, column {}", i / map.width_px, i % map.width_px));
      }
      *value = std::max(*value, 0.0f);
    }
  }
  return map;
}

}  // namespace

bool is_openexr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

absl::StatusOr<EnvironmentMap> read_openexr(std::string_view bytes, const Source& source) {
  // Larger ones are refused before the library makes tables for them. One setting for the whole process.
  static std::once_flag once;
  std::call_once(once, [] { Imf::Header::setMaxImageSize(kLargestMapWidth_px, kLargestMapHeight_px); });
  try {
    return decode(bytes, source);
  } catch (const std::bad_alloc&) {
    return source.error(absl::StatusCode::kResourceExhausted, "takes more memory than there is");
  } catch (const std::exception& error) {
    return source.malformed(error.what());
  }
}

}  // namespace diaphane::readers

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "tests/support/decoders.h"
#include "webp/demux.h"

namespace diaphane::testing_support {

std::optional<Animation> decode_webp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const WebPData data{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, decltype(&WebPAnimDecoderDelete)> decoder(WebPAnimDecoderNew(&data, nullptr),
                                                                                   &WebPAnimDecoderDelete);
  WebPAnimInfo info;
  if (decoder == nullptr || WebPAnimDecoderGetInfo(decoder.get(), &info) == 0) return std::nullopt;
  Animation animation{static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height), {}};
  const size_t bytes_per_frame = size_t{4} * info.canvas_width * info.canvas_height;
  uint8_t* rgba = nullptr;
  int time_ms = 0;
  while (WebPAnimDecoderGetNext(decoder.get(), &rgba, &time_ms) != 0) {
    double sum = 0;
    for (size_t i = 0; i < bytes_per_frame; i += 4) sum += rgba[i] + rgba[i + 1] + rgba[i + 2];
    animation.mean.push_back(sum / (0.75 * static_cast<double>(bytes_per_frame)));
  }
  return animation;
}

}  // namespace diaphane::testing_support

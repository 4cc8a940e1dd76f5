#include <cmath>

#include "readers/environment.h"
#include "tests/fuzz/promises.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace diaphane;
  readers::Source source;
  source.name = "fuzzed";
  const auto bytes = std::string_view(reinterpret_cast<const char*>(data), size);
  for (const auto& map : {readers::read_radiance(bytes, source), readers::read_openexr(bytes, source)}) {
    if (!map.ok()) {
      fuzz::require(map.status().message().find('\n') == absl::string_view::npos, "one line");
      fuzz::require(map.status().message().substr(0, 6) == "fuzzed", "a message that names the file");
      continue;
    }
    fuzz::require(map->radiance.size() == size_t{map->width_px} * map->height_px, "every pixel");
    for (const Rgb& pixel : map->radiance) {
      for (const float value : {pixel.r, pixel.g, pixel.b}) {
        fuzz::require(std::isfinite(value) && value >= 0, "finite light");
      }
    }
  }
  return 0;
}

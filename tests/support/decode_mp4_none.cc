#include "tests/support/decoders.h"

namespace diaphane::testing_support {

std::optional<Animation> decode_mp4(const std::filesystem::path&) { return std::nullopt; }

}  // namespace diaphane::testing_support

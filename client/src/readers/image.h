// Pictures to pixels, bounded.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "diaphane/texture.h"
#include "readers/source.h"

namespace diaphane::readers {

/// The pixels of a PNG, JPEG or WebP, told apart by content; the rest of the texture as it is by default. Of a PNG with
/// 16 bits a channel the upper eight. kInvalidArgument, in the name of `source`: it is none of them, or damaged;
/// kResourceExhausted: more than 8192 a side, or than `max_pixels` in all (nothing was allocated then). Thread-safe.
absl::StatusOr<TextureData> decode_image(std::string_view bytes, uint64_t max_pixels, const Source& source);

}  // namespace diaphane::readers

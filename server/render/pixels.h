// A frame's pixels in memory.
#pragma once

#include <span>

#include "glm/vec4.hpp"
#include "render/frame.h"
#include "render/tiles.h"

namespace diaphane::render {

/// Gives `frame` a picture of the request's size and channels, in the memory of the one that it had. Its pixels are
/// to be written, all of them.
Canvas make_canvas(Frame& frame, const FrameRequest& request, PixelFormat format);

/// Linear radiance to RGBA32F, or after scaling to RGBA8 with sRGB-encoded colour, as GL does it.
void store_pixels(std::span<const glm::vec4> radiance, float radiance_scale, PixelFormat format, uint8_t* pixels);

}  // namespace diaphane::render

// What one view is drawn into: the G-buffer, and the picture.
#pragma once

#include <cstdint>

#include "gl/objects.h"
#include "glm/vec4.hpp"
#include "render/frame.h"

namespace diaphane::render {

/// Targets of one tile. Kept from frame to frame while the size and format are the same. Render thread only.
class ViewTargets {
 public:
  ViewTargets(uint32_t width_px, uint32_t height_px, PixelFormat format);

  bool fits(uint32_t width_px, uint32_t height_px, PixelFormat format) const {
    return width_px_ == width_px && height_px_ == height_px && format_ == format;
  }

  /// Clears the G-buffer and makes it the target.
  void begin_gbuffer() const;
  /// Clears the picture to transparent black and the depth, and makes both the target: for meshes drawn straight into
  /// it.
  void begin_forward() const;
  /// Clears the picture to transparent black, makes it the target, and binds the G-buffer for sampling.
  void begin_shading() const;

  /// Reads `width_px` × `height_px` pixels from the tile's lowest-left corner. Rows bottom to top; `pixels` holds RGBA8
  /// or RGBA32F by the format.
  void read_back(uint32_t width_px, uint32_t height_px, void* pixels) const;

  /// Reads the G-buffer: mm and mesh id, normal and facet sine; RGBA32F, rows bottom to top.
  void read_gbuffer(uint32_t width_px, uint32_t height_px, glm::vec4* positions, glm::vec4* normals) const;

 private:
  uint32_t width_px_;
  uint32_t height_px_;
  PixelFormat format_;
  gl::Texture position_;
  gl::Texture normal_;
  gl::Texture depth_;
  gl::Texture picture_;
  gl::Framebuffer gbuffer_;
  gl::Framebuffer shading_;
  gl::Framebuffer forward_;
};

}  // namespace diaphane::render

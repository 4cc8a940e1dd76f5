// What one view is drawn into: the G-buffer, and the picture.
#pragma once

#include <cstdint>
#include <optional>

#include "gl/objects.h"
#include "glm/vec4.hpp"
#include "render/frame.h"
#include "render/shading.h"

namespace diaphane::render {

/// Targets of one tile. Kept from frame to frame while the size and format are the same; what a variant needs more is
/// made when it is first used. Render thread only.
class ViewTargets {
 public:
  ViewTargets(uint32_t width_px, uint32_t height_px, PixelFormat format);

  bool fits(uint32_t width_px, uint32_t height_px, PixelFormat format) const {
    return width_px_ == width_px && height_px_ == height_px && format_ == format;
  }

  /// Clears the G-buffer and makes it the target; E is a part of it where the variant is lit, albedo and coat where it
  /// is textured.
  void begin_gbuffer(Variant variant);
  /// Clears the picture to transparent black and the depth, and makes both the target: for meshes drawn straight into
  /// it. Channels of the variant likewise.
  void begin_forward(Variant variant);
  /// Clears the picture to transparent black, makes it the target, and binds the G-buffer for sampling.
  void begin_shading(Variant variant);

  /// Reads `width_px` × `height_px` pixels from the tile's lowest-left corner. Rows bottom to top; `pixels` holds RGBA8
  /// or RGBA32F by the format.
  void read_back(uint32_t width_px, uint32_t height_px, void* pixels) const;

  /// Reads the G-buffer: mm and mesh id, normal and facet sine; RGBA32F, rows bottom to top.
  void read_gbuffer(uint32_t width_px, uint32_t height_px, glm::vec4* positions, glm::vec4* normals) const;

  /// Reads what a textured G-buffer has more: the albedo in rgb; the coat's normal, and in a the share of its alpha.
  void read_textured(uint32_t width_px, uint32_t height_px, glm::vec4* albedo, glm::vec4* coat) const;

  /// Reads what the last pass with channels left: E and B in rgb, RGBA32F, rows bottom to top.
  void read_channels(uint32_t width_px, uint32_t height_px, glm::vec4* irradiance, glm::vec4* radiosity) const;

 private:
  struct Textured {
    gl::Texture albedo;
    gl::Texture coat;
  };
  struct Channels {
    gl::Texture irradiance;
    gl::Texture radiosity;
    gl::Framebuffer shading;
    gl::Framebuffer forward;
  };
  void attach_gbuffer(Variant variant);
  const Channels& channels();

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
  std::optional<gl::Texture> entering_;
  std::optional<Textured> textured_;
  std::optional<Channels> channels_;
};

}  // namespace diaphane::render

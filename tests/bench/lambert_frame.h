// A plain opaque frame, drawn by a program that knows nothing of translucency: the yardstick of the benches. It stays
// as it is, so that figures of different days compare.
#pragma once

#include <span>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "glm/mat4x4.hpp"
#include "glm/vec3.hpp"

namespace diaphane::bench {

/// One mesh, one point light, E/π by fragment into 8-bit sRGB with a depth buffer. The thread of a current GL context.
class LambertFrame {
 public:
  LambertFrame(std::span<const glm::uvec3> triangles, uint32_t size_px);

  /// New positions and normals, given: nothing is computed from them here.
  void upload(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) const;
  /// Draws and reads the picture back.
  void draw(const glm::mat4& clip_from_world, const glm::vec3& light_position);

  /// RGBA8, rows bottom to top.
  const std::vector<uint8_t>& pixels() const { return pixels_; }

 private:
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer positions_, normals_, indices_;
  gl::Texture colour_, depth_;
  gl::Framebuffer target_;
  GLsizei index_count_;
  uint32_t size_px_;
  std::vector<uint8_t> pixels_;
};

}  // namespace diaphane::bench

#include "render/cube_atlas.h"

#include <algorithm>
#include <utility>

#include "glm/common.hpp"

namespace diaphane::render {
namespace {

constexpr GLsizei kFaces = 6;
// An empty texel's key: agrees with no point, and stays finite in arithmetic.
constexpr float kNoKey = 1e30f;

void allocate_layers(const gl::Texture& texture, GLenum internal_format, uint32_t size_px, GLenum filter,
                     const float (&border)[4]) {
  const auto size = static_cast<GLsizei>(size_px);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, internal_format, size, size, kFaces);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  // Taps beyond the box find nothing.
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  glTexParameterfv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BORDER_COLOR, border);
}

}  // namespace

BoxUniforms fit_box(const geometry::Bounds& bounds_mm, uint32_t face_size_px) {
  BoxUniforms box;
  box.centre_mm = glm::vec4(0.5f * (bounds_mm.lowest + bounds_mm.highest), 0);
  const glm::vec3 extent = bounds_mm.highest - bounds_mm.lowest;
  const float longest = std::max({extent.x, extent.y, extent.z, 1e-6f});
  // The margin keeps the outermost surface off the clip planes.
  box.extent_mm = glm::vec4(glm::max(extent * 1.001f, glm::vec3(longest * 1e-3f)), 0);
  box.face_size_px = static_cast<int32_t>(face_size_px);
  return box;
}

CubeAtlas::CubeAtlas(AtlasKey key, const BoxUniforms& box) : key_(std::move(key)), box_(box) {
  allocate_layers(irradiance_, GL_RGBA32F, key_.face_size_px, GL_LINEAR, {0, 0, 0, kNoKey});
  allocate_layers(surface_, GL_RGBA32F, key_.face_size_px, GL_LINEAR, {0, 0, 0, 0});
  gl::storage_2d(depth_, GL_DEPTH_COMPONENT32F, key_.face_size_px, key_.face_size_px);
}

void CubeAtlas::render(const gl::Program& program, absl::FunctionRef<void(bool mirrored)> draw_mesh) {
  const auto size = static_cast<GLsizei>(key_.face_size_px);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, attachments);
  glViewport(0, 0, size, size);
  glEnable(GL_DEPTH_TEST);
  glUseProgram(program.id());
  for (GLint face = 0; face < kFaces; ++face) {
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, irradiance_.id(), 0, face);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, surface_.id(), 0, face);
    const float no_irradiance[] = {0, 0, 0, kNoKey};
    const float no_surface[] = {0, 0, 0, 0};
    const float far = 1;
    glClearBufferfv(GL_COLOR, 0, no_irradiance);
    glClearBufferfv(GL_COLOR, 1, no_surface);
    glClearBufferfv(GL_DEPTH, 0, &far);
    glProgramUniform1i(program.id(), 0, face);
    // Seen from below, u and v are a left-handed pair.
    draw_mesh(face % 2 == 1);
  }
}

size_t CubeAtlas::bytes() const {
  constexpr size_t kBytesPerTexel = 2 * 4 * sizeof(float);
  return kFaces * kBytesPerTexel * key_.face_size_px * key_.face_size_px;
}

}  // namespace diaphane::render

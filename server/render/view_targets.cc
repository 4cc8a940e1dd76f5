#include "render/view_targets.h"

#include "render/uniforms.h"

namespace diaphane::render {
namespace {

void attach(GLenum attachment, const gl::Texture& texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.id(), 0);
}

constexpr float kNothing[] = {0, 0, 0, 0};

}  // namespace

ViewTargets::ViewTargets(uint32_t width_px, uint32_t height_px, PixelFormat format)
    : width_px_(width_px), height_px_(height_px), format_(format) {
  gl::storage_2d(position_, GL_RGBA32F, width_px, height_px);
  gl::storage_2d(normal_, GL_RGBA32F, width_px, height_px);
  gl::storage_2d(depth_, GL_DEPTH_COMPONENT32F, width_px, height_px);
  gl::storage_2d(picture_, format == PixelFormat::kSrgb8 ? GL_SRGB8_ALPHA8 : GL_RGBA32F, width_px, height_px);

  glBindFramebuffer(GL_FRAMEBUFFER, gbuffer_.id());
  attach(GL_COLOR_ATTACHMENT0, position_);
  attach(GL_COLOR_ATTACHMENT1, normal_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, attachments);

  glBindFramebuffer(GL_FRAMEBUFFER, shading_.id());
  attach(GL_COLOR_ATTACHMENT0, picture_);

  glBindFramebuffer(GL_FRAMEBUFFER, forward_.id());
  attach(GL_COLOR_ATTACHMENT0, picture_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
}

void ViewTargets::begin_gbuffer() const {
  const float far = 1;
  glBindFramebuffer(GL_FRAMEBUFFER, gbuffer_.id());
  glClearBufferfv(GL_COLOR, 0, kNothing);
  glClearBufferfv(GL_COLOR, 1, kNothing);
  glClearBufferfv(GL_DEPTH, 0, &far);
  glEnable(GL_DEPTH_TEST);
}

void ViewTargets::begin_forward() const {
  const float far = 1;
  glBindFramebuffer(GL_FRAMEBUFFER, forward_.id());
  glClearBufferfv(GL_COLOR, 0, kNothing);
  glClearBufferfv(GL_DEPTH, 0, &far);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
}

void ViewTargets::begin_shading() const {
  glBindFramebuffer(GL_FRAMEBUFFER, shading_.id());
  glClearBufferfv(GL_COLOR, 0, kNothing);
  glDisable(GL_DEPTH_TEST);
  // Linear radiance becomes sRGB as it is stored, in pictures alone.
  glEnable(GL_FRAMEBUFFER_SRGB);
  gl::bind_texture(UNIT_GBUFFER_POSITION, GL_TEXTURE_2D, position_);
  gl::bind_texture(UNIT_GBUFFER_NORMAL, GL_TEXTURE_2D, normal_);
}

void ViewTargets::read_back(uint32_t width_px, uint32_t height_px, void* pixels) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, shading_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, static_cast<GLsizei>(width_px), static_cast<GLsizei>(height_px), GL_RGBA,
               format_ == PixelFormat::kSrgb8 ? GL_UNSIGNED_BYTE : GL_FLOAT, pixels);
}

void ViewTargets::read_gbuffer(uint32_t width_px, uint32_t height_px, glm::vec4* positions, glm::vec4* normals) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, gbuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  const auto width = static_cast<GLsizei>(width_px);
  const auto height = static_cast<GLsizei>(height_px);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, positions);
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, normals);
}

}  // namespace diaphane::render

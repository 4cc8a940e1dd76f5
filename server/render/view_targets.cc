#include "render/view_targets.h"

#include "render/uniforms.h"

namespace diaphane::render {
namespace {

void attach(GLenum attachment, const gl::Texture& texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.id(), 0);
}

void draw_to_first(GLsizei count) {
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(count, attachments);
}

void clear_colours(GLint count) {
  constexpr float kNothing[] = {0, 0, 0, 0};
  for (GLint i = 0; i < count; ++i) glClearBufferfv(GL_COLOR, i, kNothing);
}

void clear_depth() {
  const float far = 1;
  glClearBufferfv(GL_DEPTH, 0, &far);
  glEnable(GL_DEPTH_TEST);
}

void read_float(GLenum attachment, uint32_t width_px, uint32_t height_px, glm::vec4* pixels) {
  glReadBuffer(attachment);
  glReadPixels(0, 0, static_cast<GLsizei>(width_px), static_cast<GLsizei>(height_px), GL_RGBA, GL_FLOAT, pixels);
}

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

  glBindFramebuffer(GL_FRAMEBUFFER, shading_.id());
  attach(GL_COLOR_ATTACHMENT0, picture_);

  glBindFramebuffer(GL_FRAMEBUFFER, forward_.id());
  attach(GL_COLOR_ATTACHMENT0, picture_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
}

/// To the bound framebuffer: what the variant has, and nothing where it has not.
void ViewTargets::attach_gbuffer(Variant variant) {
  if (variant.lit && !entering_.has_value()) {
    gl::storage_2d(entering_.emplace(), GL_RGBA32F, width_px_, height_px_);
  }
  if (variant.textured && !textured_.has_value()) {
    const Textured& made = textured_.emplace();
    gl::storage_2d(made.albedo, GL_RGBA16F, width_px_, height_px_);
    gl::storage_2d(made.coat, GL_RGBA16F, width_px_, height_px_);
  }
  GLenum drawn[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT0 + TARGET_NORMAL, GL_NONE, GL_NONE, GL_NONE};
  const auto attach_or_detach = [&](GLuint target, const gl::Texture* texture) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + target;
    if (texture != nullptr) drawn[target] = attachment;
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture == nullptr ? 0 : texture->id(), 0);
  };
  attach_or_detach(TARGET_ENTERING, variant.lit ? &*entering_ : nullptr);
  attach_or_detach(TARGET_ALBEDO, variant.textured ? &textured_->albedo : nullptr);
  attach_or_detach(TARGET_COAT, variant.textured ? &textured_->coat : nullptr);
  glDrawBuffers(TARGET_COAT + 1, drawn);
}

const ViewTargets::Channels& ViewTargets::channels() {
  if (channels_.has_value()) return *channels_;
  const Channels& made = channels_.emplace();
  gl::storage_2d(made.irradiance, GL_RGBA32F, width_px_, height_px_);
  gl::storage_2d(made.radiosity, GL_RGBA32F, width_px_, height_px_);
  for (const gl::Framebuffer* framebuffer : {&made.shading, &made.forward}) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer->id());
    attach(GL_COLOR_ATTACHMENT0 + TARGET_RADIANCE, picture_);
    attach(GL_COLOR_ATTACHMENT0 + TARGET_IRRADIANCE, made.irradiance);
    attach(GL_COLOR_ATTACHMENT0 + TARGET_RADIOSITY, made.radiosity);
    draw_to_first(3);
  }
  attach(GL_DEPTH_ATTACHMENT, depth_);
  return made;
}

void ViewTargets::begin_gbuffer(Variant variant) {
  glBindFramebuffer(GL_FRAMEBUFFER, gbuffer_.id());
  attach_gbuffer(variant);
  clear_colours(TARGET_COAT + 1);
  clear_depth();
}

void ViewTargets::begin_forward(Variant variant) {
  glBindFramebuffer(GL_FRAMEBUFFER, variant.channels ? channels().forward.id() : forward_.id());
  clear_colours(variant.channels ? 3 : 1);
  clear_depth();
  glEnable(GL_FRAMEBUFFER_SRGB);
}

void ViewTargets::begin_shading(Variant variant) {
  glBindFramebuffer(GL_FRAMEBUFFER, variant.channels ? channels().shading.id() : shading_.id());
  clear_colours(variant.channels ? 3 : 1);
  glDisable(GL_DEPTH_TEST);
  // Linear radiance becomes sRGB as it is stored, in pictures alone.
  glEnable(GL_FRAMEBUFFER_SRGB);
  gl::bind_texture(UNIT_GBUFFER_POSITION, GL_TEXTURE_2D, position_);
  gl::bind_texture(UNIT_GBUFFER_NORMAL, GL_TEXTURE_2D, normal_);
  if (variant.lit) gl::bind_texture(UNIT_GBUFFER_IRRADIANCE, GL_TEXTURE_2D, *entering_);
  if (variant.textured) gl::bind_texture(UNIT_GBUFFER_ALBEDO, GL_TEXTURE_2D, textured_->albedo);
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
  read_float(GL_COLOR_ATTACHMENT0, width_px, height_px, positions);
  read_float(GL_COLOR_ATTACHMENT1, width_px, height_px, normals);
}

void ViewTargets::read_textured(uint32_t width_px, uint32_t height_px, glm::vec4* albedo, glm::vec4* coat) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, gbuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  read_float(GL_COLOR_ATTACHMENT0 + TARGET_ALBEDO, width_px, height_px, albedo);
  read_float(GL_COLOR_ATTACHMENT0 + TARGET_COAT, width_px, height_px, coat);
}

void ViewTargets::read_channels(uint32_t width_px, uint32_t height_px, glm::vec4* irradiance,
                                glm::vec4* radiosity) const {
  if (!channels_.has_value()) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, channels_->shading.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  read_float(GL_COLOR_ATTACHMENT0 + TARGET_IRRADIANCE, width_px, height_px, irradiance);
  read_float(GL_COLOR_ATTACHMENT0 + TARGET_RADIOSITY, width_px, height_px, radiosity);
}

}  // namespace diaphane::render

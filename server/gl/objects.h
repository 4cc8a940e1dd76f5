// GL objects as values: move-only, freed on destruction. Names mirror GL's.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace diaphane::gl {

/// An object id and who frees it. Render thread only, with the context current, from birth to death.
template <auto Generate, auto Delete>
class Object {
 public:
  Object() { Generate(&id_); }
  ~Object() {
    if (id_ != 0) Delete(&id_);
  }
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

namespace detail {
inline void gen_buffer(GLuint* id) { glGenBuffers(1, id); }
inline void delete_buffer(const GLuint* id) { glDeleteBuffers(1, id); }
inline void gen_texture(GLuint* id) { glGenTextures(1, id); }
inline void delete_texture(const GLuint* id) { glDeleteTextures(1, id); }
inline void gen_framebuffer(GLuint* id) { glGenFramebuffers(1, id); }
inline void delete_framebuffer(const GLuint* id) { glDeleteFramebuffers(1, id); }
inline void gen_vertex_array(GLuint* id) { glGenVertexArrays(1, id); }
inline void delete_vertex_array(const GLuint* id) { glDeleteVertexArrays(1, id); }
}  // namespace detail

using Buffer = Object<detail::gen_buffer, detail::delete_buffer>;
using Texture = Object<detail::gen_texture, detail::delete_texture>;
using Framebuffer = Object<detail::gen_framebuffer, detail::delete_framebuffer>;
using VertexArray = Object<detail::gen_vertex_array, detail::delete_vertex_array>;

/// Replaces what `buffer` holds.
inline void upload(const Buffer& buffer, GLenum target, const void* data, size_t bytes, GLenum usage) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
}

/// Immutable storage of one level. Sizes in pixels; the internal format names its channels and bits.
inline void storage_2d(const Texture& texture, GLenum internal_format, uint32_t width_px, uint32_t height_px) {
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexStorage2D(GL_TEXTURE_2D, 1, internal_format, static_cast<GLsizei>(width_px), static_cast<GLsizei>(height_px));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

/// Binds a 2-D texture or an array of them to a texture unit for sampling.
inline void bind_texture(GLuint unit, GLenum target, const Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target, texture.id());
}

}  // namespace diaphane::gl

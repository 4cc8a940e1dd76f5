#include "tests/bench/lambert_frame.h"

#include <stdexcept>

#include "glm/gtc/type_ptr.hpp"

namespace diaphane::bench {
namespace {

constexpr const char* kVertexShader = R"(#version 430 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) uniform mat4 clip_from_world;
out vec3 world_position;
out vec3 world_normal;
void main() {
  world_position = position;
  world_normal = normal;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(#version 430 core
in vec3 world_position;
in vec3 world_normal;
layout(location = 1) uniform vec3 light_position;
layout(location = 0) out vec4 colour;
void main() {
  vec3 to_light = light_position - world_position;
  float falloff = 2500.0 / dot(to_light, to_light);
  float cosine = max(dot(normalize(world_normal), normalize(to_light)), 0.0);
  colour = vec4(vec3(falloff * cosine / 3.14159265), 1.0);
}
)";

gl::Program link() {
  auto program = gl::Program::link("lambert frame", kVertexShader, kFragmentShader);
  if (!program.ok()) throw std::runtime_error(std::string(program.status().message()));
  return *std::move(program);
}

void fill(const gl::Buffer& buffer, GLuint location, std::span<const glm::vec3> values) {
  gl::upload(buffer, GL_ARRAY_BUFFER, values.data(), values.size_bytes(), GL_STREAM_DRAW);
  glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glEnableVertexAttribArray(location);
}

}  // namespace

LambertFrame::LambertFrame(std::span<const glm::uvec3> triangles, uint32_t size_px)
    : program_(link()),
      index_count_(static_cast<GLsizei>(3 * triangles.size())),
      size_px_(size_px),
      pixels_(size_t{4} * size_px * size_px) {
  glBindVertexArray(vertex_array_.id());
  gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, triangles.data(), triangles.size_bytes(), GL_STATIC_DRAW);
  gl::storage_2d(colour_, GL_SRGB8_ALPHA8, size_px, size_px);
  gl::storage_2d(depth_, GL_DEPTH_COMPONENT32F, size_px, size_px);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
}

void LambertFrame::upload(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) const {
  glBindVertexArray(vertex_array_.id());
  fill(positions_, 0, positions);
  fill(normals_, 1, normals);
}

void LambertFrame::draw(const glm::mat4& clip_from_world, const glm::vec3& light_position) {
  const float black[] = {0, 0, 0, 0};
  const float far = 1;
  const auto size = static_cast<GLsizei>(size_px_);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
  glViewport(0, 0, size, size);
  glClearBufferfv(GL_COLOR, 0, black);
  glClearBufferfv(GL_DEPTH, 0, &far);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glUseProgram(program_.id());
  glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(clip_from_world));
  glUniform3fv(1, 1, glm::value_ptr(light_position));
  glBindVertexArray(vertex_array_.id());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, pixels_.data());
  glDisable(GL_CULL_FACE);
}

}  // namespace diaphane::bench

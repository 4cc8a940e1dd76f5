#include "render/shading.h"

namespace diaphane::render {
namespace {

int32_t term_bits(Terms terms) {
  switch (terms) {
    case Terms::kLocal:
      return TERM_LOCAL;
    case Terms::kGlobal:
      return TERM_GLOBAL;
    case Terms::kBoth:
      break;
  }
  return TERM_LOCAL | TERM_GLOBAL;
}

}  // namespace

absl::StatusOr<Shading> Shading::load(const gl::ShaderLibrary& library) {
  auto atlas = gl::load_program(library, "atlas.vert", "atlas.frag");
  if (!atlas.ok()) return atlas.status();
  auto gbuffer = gl::load_program(library, "gbuffer.vert", "gbuffer.frag");
  if (!gbuffer.ok()) return gbuffer.status();
  auto integral = gl::load_program(library, "integral.vert", "integral.frag");
  if (!integral.ok()) return integral.status();
  auto paper = gl::load_program(library, "fullscreen.vert", "paper_shade.frag");
  if (!paper.ok()) return paper.status();
  auto lambert = gl::load_program(library, "fullscreen.vert", "lambert_shade.frag");
  if (!lambert.ok()) return lambert.status();
  return Shading(*std::move(atlas), *std::move(gbuffer), *std::move(integral), *std::move(paper), *std::move(lambert));
}

void Shading::bind_uniforms(GLuint binding, const gl::Buffer& buffer, const void* data, size_t bytes) const {
  gl::upload(buffer, GL_UNIFORM_BUFFER, data, bytes, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
}

void Shading::bind(std::span<const LightStorage> lights) const {
  gl::upload(lights_, GL_SHADER_STORAGE_BUFFER, lights.data(), lights.size_bytes(), GL_STREAM_DRAW);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, STORAGE_LIGHTS, lights_.id());
}

void Shading::draw_full_screen(const gl::Program& program) const {
  glUseProgram(program.id());
  glBindVertexArray(no_attributes_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Shading::shade_paper(const CubeAtlas& atlas, const PaperSettings& settings) const {
  const PaperUniforms paper{term_bits(settings.terms), static_cast<int32_t>(settings.kernel_taps),
                            settings.global_gain};
  bind_uniforms(UNIFORMS_PAPER, paper_, &paper, sizeof paper);
  bind(atlas.box());
  gl::bind_texture(UNIT_ATLAS_IRRADIANCE, GL_TEXTURE_2D_ARRAY, atlas.irradiance());
  gl::bind_texture(UNIT_ATLAS_SURFACE, GL_TEXTURE_2D_ARRAY, atlas.surface());
  draw_full_screen(paper_program_);
}

void Shading::shade_lambert() const { draw_full_screen(lambert_program_); }

}  // namespace diaphane::render

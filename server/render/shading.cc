#include "render/shading.h"

#include <string>
#include <vector>

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

struct PassFiles {
  const char* vertex;
  const char* fragment;
  bool lit;       ///< has a variant for it
  bool channels;  ///< likewise
  bool textured;  ///< likewise
};

// In the order of Shading::Pass.
constexpr PassFiles kFiles[] = {{"atlas.vert", "atlas.frag", true, false, false},
                                {"gbuffer.vert", "gbuffer.frag", true, false, true},
                                {"integral.vert", "integral.frag", false, true, true},
                                {"fullscreen.vert", "paper_shade.frag", true, true, true},
                                {"fullscreen.vert", "lambert_shade.frag", true, true, true}};

}  // namespace

absl::StatusOr<Shading> Shading::load(const gl::ShaderLibrary& library) {
  Shading shading(library);
  for (int pass = 0; pass < kPasses; ++pass) {
    if (absl::Status loaded = shading.load_program(static_cast<Pass>(pass), {}); !loaded.ok()) return loaded;
  }
  return shading;
}

size_t Shading::slot_of(Pass pass, Variant variant) {
  const size_t lit = variant.lit && kFiles[pass].lit ? 1 : 0;
  const size_t channels = variant.channels && kFiles[pass].channels ? 2 : 0;
  const size_t textured = variant.textured && kFiles[pass].textured ? 4 : 0;
  return kVariants * pass + lit + channels + textured;
}

absl::Status Shading::load_program(Pass pass, Variant variant) {
  std::optional<gl::Program>& slot = programs_[slot_of(pass, variant)];
  if (slot.has_value()) return absl::OkStatus();
  std::string defines;
  if (variant.lit) defines += "#define LIT\n";
  if (variant.channels) defines += "#define CHANNELS\n";
  if (variant.textured) defines += "#define TEXTURED\n";
  auto program = gl::load_program(library_, kFiles[pass].vertex, kFiles[pass].fragment, defines);
  if (!program.ok()) return program.status();
  slot.emplace(*std::move(program));
  return absl::OkStatus();
}

absl::Status Shading::prepare(Technique technique, Variant variant) {
  std::span<const Pass> passes;
  // Extra channels and coats of the integral ask for the G-buffer.
  static constexpr Pass kOfIntegral[] = {kIntegral, kGbuffer}, kOfReference[] = {kGbuffer};
  static constexpr Pass kOfPaper[] = {kAtlas, kGbuffer, kPaper}, kOfLambert[] = {kGbuffer, kLambert};
  if (technique == Technique::kIntegral) passes = kOfIntegral;
  if (technique == Technique::kReference) passes = kOfReference;
  if (technique == Technique::kPaper) passes = kOfPaper;
  if (technique == Technique::kLambert) passes = kOfLambert;
  for (const Pass pass : passes) {
    if (absl::Status loaded = load_program(pass, variant); !loaded.ok()) return loaded;
  }
  return absl::OkStatus();
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

void Shading::shade_paper(const CubeAtlas& atlas, const PaperSettings& settings, Variant variant) const {
  const PaperUniforms paper{term_bits(settings.terms), static_cast<int32_t>(settings.kernel_taps),
                            settings.global_gain};
  bind_uniforms(UNIFORMS_PAPER, paper_, &paper, sizeof paper);
  bind(atlas.box());
  gl::bind_texture(UNIT_ATLAS_IRRADIANCE, GL_TEXTURE_2D_ARRAY, atlas.irradiance());
  gl::bind_texture(UNIT_ATLAS_SURFACE, GL_TEXTURE_2D_ARRAY, atlas.surface());
  draw_full_screen(program(kPaper, variant));
}

}  // namespace diaphane::render

// The programs of all passes, and the buffers that feed them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "absl/status/statusor.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "render/cube_atlas.h"
#include "render/frame.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// How the passes of a frame differ from the plain ones. A pass to which a difference does not matter ignores it.
struct Variant {
  bool lit = false;       ///< E is not the shader's own but the vertices', shadows included (LIT)
  bool channels = false;  ///< irradiance and radiosity are made beside radiance (CHANNELS)
  bool textured = false;  ///< textures and colours of vertices are read (TEXTURED)
};

/// Render thread only. Each `bind` uploads a block and leaves it bound for the draws that follow.
class Shading {
 public:
  /// Every plain program. Variants follow when a frame first needs them.
  static absl::StatusOr<Shading> load(const gl::ShaderLibrary& library);

  /// Loads what frames of `technique` need of `variant`. Errors: those of gl::load_program.
  absl::Status prepare(Technique technique, Variant variant);

  void bind(const ViewUniforms& view) const { bind_uniforms(UNIFORMS_VIEW, view_, &view, sizeof view); }
  void bind(const MaterialUniforms& m) const { bind_uniforms(UNIFORMS_MATERIAL, material_, &m, sizeof m); }
  void bind(const BoxUniforms& box) const { bind_uniforms(UNIFORMS_BOX, box_, &box, sizeof box); }
  void bind(std::span<const LightStorage> lights) const;

  /// What was not prepared must not be asked for.
  const gl::Program& atlas(Variant variant = {}) const { return program(kAtlas, variant); }
  const gl::Program& gbuffer(Variant variant = {}) const { return program(kGbuffer, variant); }
  const gl::Program& integral(Variant variant = {}) const { return program(kIntegral, variant); }

  /// Full screen, over a bound G-buffer; what is bound must be the mesh's.
  void shade_paper(const CubeAtlas& atlas, const PaperSettings& settings, Variant variant) const;
  void shade_lambert(Variant variant) const { draw_full_screen(program(kLambert, variant)); }

 private:
  enum Pass { kAtlas, kGbuffer, kIntegral, kPaper, kLambert, kPasses };
  static constexpr size_t kVariants = 8;

  explicit Shading(const gl::ShaderLibrary& library) : library_(library) {}

  static size_t slot_of(Pass pass, Variant variant);
  absl::Status load_program(Pass pass, Variant variant);
  const gl::Program& program(Pass pass, Variant variant) const { return *programs_[slot_of(pass, variant)]; }
  void bind_uniforms(GLuint binding, const gl::Buffer& buffer, const void* data, size_t bytes) const;
  void draw_full_screen(const gl::Program& program) const;

  gl::ShaderLibrary library_;
  std::array<std::optional<gl::Program>, kPasses * kVariants> programs_;
  gl::VertexArray no_attributes_;
  gl::Buffer view_;
  gl::Buffer material_;
  gl::Buffer box_;
  gl::Buffer paper_;
  gl::Buffer lights_;
};

}  // namespace diaphane::render

// The programs of all passes, and the buffers that feed them.
#pragma once

#include <span>

#include "absl/status/statusor.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "render/cube_atlas.h"
#include "render/frame.h"
#include "render/uniforms.h"

namespace diaphane::render {

/// Render thread only. Each `bind` uploads a block and leaves it bound for the draws that follow.
class Shading {
 public:
  static absl::StatusOr<Shading> load(const gl::ShaderLibrary& library);

  void bind(const ViewUniforms& view) const { bind_uniforms(UNIFORMS_VIEW, view_, &view, sizeof view); }
  void bind(const MaterialUniforms& m) const { bind_uniforms(UNIFORMS_MATERIAL, material_, &m, sizeof m); }
  void bind(const BoxUniforms& box) const { bind_uniforms(UNIFORMS_BOX, box_, &box, sizeof box); }
  void bind(std::span<const LightStorage> lights) const;

  const gl::Program& atlas() const { return atlas_program_; }
  const gl::Program& gbuffer() const { return gbuffer_program_; }
  const gl::Program& integral() const { return integral_program_; }

  /// Full screen, over a bound G-buffer; what is bound must be the mesh's.
  void shade_paper(const CubeAtlas& atlas, const PaperSettings& settings) const;
  void shade_lambert() const;

 private:
  Shading(gl::Program atlas, gl::Program gbuffer, gl::Program integral, gl::Program paper, gl::Program lambert)
      : atlas_program_(std::move(atlas)),
        gbuffer_program_(std::move(gbuffer)),
        integral_program_(std::move(integral)),
        paper_program_(std::move(paper)),
        lambert_program_(std::move(lambert)) {}
  void bind_uniforms(GLuint binding, const gl::Buffer& buffer, const void* data, size_t bytes) const;
  void draw_full_screen(const gl::Program& program) const;

  gl::Program atlas_program_;
  gl::Program gbuffer_program_;
  gl::Program integral_program_;
  gl::Program paper_program_;
  gl::Program lambert_program_;
  gl::VertexArray no_attributes_;
  gl::Buffer view_;
  gl::Buffer material_;
  gl::Buffer box_;
  gl::Buffer paper_;
  gl::Buffer lights_;
};

}  // namespace diaphane::render

// The renderer that draws with OpenGL.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "render/frame.h"

namespace diaphane::render {

/// Who finds what triangles show.
enum class Raster {
  kAuto,   ///< kNative where OpenGL is software, else kGl
  kGl,     ///< OpenGL
  kNative  ///< the CPU, for `integral` and `paper` without textures; OpenGL for the rest
};

struct GlRendererOptions {
  std::string device;      ///< see gl::ContextOptions::device
  std::string shader_dir;  ///< empty: the shaders embedded at build
  Raster raster = Raster::kAuto;
  bool warm_all = true;  ///< draw once with every program, so that no frame pays for compiling one
};

/// Makes a context on the calling thread, which alone may use and destroy the renderer.
/// Errors: those of gl::Context::create; INTERNAL when a shader does not compile; NOT_FOUND when one is missing.
absl::StatusOr<std::unique_ptr<FrameRenderer>> make_gl_renderer(const GlRendererOptions& options);

}  // namespace diaphane::render

#pragma once

#include <span>
#include <string_view>

namespace diaphane::gl {

/// A file of shaders/, as it was at build.
struct EmbeddedShader {
  std::string_view path;  ///< relative to shaders/, such as "paper_shade.frag"
  std::string_view text;
};

/// Every file of shaders/. Thread-safe.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace diaphane::gl

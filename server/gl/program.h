// Shader files and the programs made of them.
#pragma once

#include <epoxy/gl.h>

#include <string>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"

namespace diaphane::gl {

/// The text of shader files: those embedded at build, or those below a directory. Thread-safe (const).
class ShaderLibrary {
 public:
  /// `directory` empty: the embedded files.
  explicit ShaderLibrary(std::string directory = "") : directory_(std::move(directory)) {}

  /// The file at `path`, with every line `#include "…"` (relative to shaders/) replaced by that file, once each.
  /// Errors: NOT_FOUND a file is missing.
  absl::StatusOr<std::string> source(std::string_view path) const;

  /// Replaces the includes of a text that is not a file.
  absl::StatusOr<std::string> expand(std::string_view text) const;

 private:
  absl::StatusOr<std::string> read(std::string_view path) const;

  std::string directory_;
};

/// A linked program. Render thread only.
class Program {
 public:
  /// Vertex and fragment shader from GLSL text, includes expanded. Errors: INTERNAL with the compiler's log.
  static absl::StatusOr<Program> link(std::string_view label, const std::string& vertex, const std::string& fragment);
  ~Program();
  Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  GLuint id() const { return id_; }

 private:
  explicit Program(GLuint id) : id_(id) {}
  GLuint id_ = 0;
};

/// Reads both files from `library` and links them. `defines` are whole lines, put behind each file's #version.
absl::StatusOr<Program> load_program(const ShaderLibrary& library, std::string_view vertex_path,
                                     std::string_view fragment_path, std::string_view defines = "");

}  // namespace diaphane::gl

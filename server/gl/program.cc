#include "gl/program.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "fmt/format.h"
#include "gl/embedded_shaders.h"

namespace diaphane::gl {
namespace {

constexpr std::string_view kInclude = "#include \"";

absl::StatusOr<GLuint> compile(std::string_view label, GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  char log[2048] = "";
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  glDeleteShader(shader);
  return absl::InternalError(fmt::format("{} does not compile: {}", label, log));
}

}  // namespace

absl::StatusOr<std::string> ShaderLibrary::read(std::string_view path) const {
  if (directory_.empty()) {
    for (const EmbeddedShader& shader : embedded_shaders()) {
      if (shader.path == path) return std::string(shader.text);
    }
    return absl::NotFoundError(fmt::format("shader {} is not in this build", path));
  }
  std::ifstream file(std::filesystem::path(directory_) / path, std::ios::binary);
  if (!file) return absl::NotFoundError(fmt::format("shader {} is not in {}", path, directory_));
  return std::string(std::istreambuf_iterator<char>(file), {});
}

absl::StatusOr<std::string> ShaderLibrary::source(std::string_view path) const {
  absl::StatusOr<std::string> text = read(path);
  if (!text.ok()) return text;
  return expand(*text);
}

absl::StatusOr<std::string> ShaderLibrary::expand(std::string_view text) const {
  std::string expanded(text);
  std::set<std::string> seen;
  for (size_t at = expanded.find(kInclude); at != std::string::npos; at = expanded.find(kInclude, at)) {
    const size_t begin = at + kInclude.size();
    const size_t end = expanded.find('"', begin);
    if (end == std::string::npos) return absl::InternalError("shader include without a closing quote");
    const std::string path = expanded.substr(begin, end - begin);
    std::string included;
    if (seen.insert(path).second) {
      absl::StatusOr<std::string> file = read(path);
      if (!file.ok()) return file;
      included = *std::move(file);
    }
    expanded.replace(at, end + 1 - at, included);
  }
  return expanded;
}

absl::StatusOr<Program> Program::link(std::string_view label, const std::string& vertex, const std::string& fragment) {
  const auto vertex_shader = compile(fmt::format("vertex shader of {}", label), GL_VERTEX_SHADER, vertex);
  if (!vertex_shader.ok()) return vertex_shader.status();
  const auto fragment_shader = compile(fmt::format("fragment shader of {}", label), GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader.ok()) {
    glDeleteShader(*vertex_shader);
    return fragment_shader.status();
  }
  Program program(glCreateProgram());
  glAttachShader(program.id(), *vertex_shader);
  glAttachShader(program.id(), *fragment_shader);
  glLinkProgram(program.id());
  glDeleteShader(*vertex_shader);
  glDeleteShader(*fragment_shader);
  GLint linked = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  char log[2048] = "";
  glGetProgramInfoLog(program.id(), sizeof log, nullptr, log);
  return absl::InternalError(fmt::format("{} does not link: {}", label, log));
}

Program::~Program() {
  if (id_ != 0) glDeleteProgram(id_);
}

absl::StatusOr<Program> load_program(const ShaderLibrary& library, std::string_view vertex_path,
                                     std::string_view fragment_path, std::string_view defines) {
  absl::StatusOr<std::string> vertex = library.source(vertex_path);
  if (!vertex.ok()) return vertex.status();
  absl::StatusOr<std::string> fragment = library.source(fragment_path);
  if (!fragment.ok()) return fragment.status();
  for (std::string* text : {&*vertex, &*fragment}) text->insert(text->find('\n') + 1, defines);
  return Program::link(fmt::format("{} + {}", vertex_path, fragment_path), *vertex, *fragment);
}

}  // namespace diaphane::gl

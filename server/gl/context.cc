#include "gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/log.h"
#include "base/status.h"
#include "fmt/format.h"

namespace diaphane::gl {
namespace {

struct Candidate {
  EGLDisplay display = EGL_NO_DISPLAY;
  std::string label;  ///< "EGL device 0 (software)"
  bool software = false;
};

bool has_extension(const char* extensions, std::string_view name) {
  if (extensions == nullptr) return false;
  const std::string padded = fmt::format(" {} ", extensions);
  return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

std::vector<Candidate> list_candidates() {
  std::vector<Candidate> candidates;
  const char* client_extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has_extension(client_extensions, "EGL_EXT_platform_device") &&
      has_extension(client_extensions, "EGL_EXT_device_enumeration")) {
    EGLint count = 0;
    eglQueryDevicesEXT(0, nullptr, &count);
    std::vector<EGLDeviceEXT> devices(static_cast<size_t>(std::max(count, 0)));
    if (count > 0) eglQueryDevicesEXT(count, devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
      const bool software =
          has_extension(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
      candidates.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
                            fmt::format("EGL device {}{}", i, software ? " (software)" : ""), software});
    }
  }
  if (has_extension(client_extensions, "EGL_MESA_platform_surfaceless")) {
    candidates.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                          "EGL surfaceless platform", true});
  }
  return candidates;
}

/// A context on an initialised display, current and without a surface; or null.
EGLContext make_context(EGLDisplay display, EGLint minor, bool robust) {
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                    EGL_CONTEXT_MINOR_VERSION,       minor,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  if (robust) {
    attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  }
  attributes.push_back(EGL_NONE);
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return context;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "" : text;
}

void GLAPIENTRY log_debug_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* message,
                                  const void*) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  const std::string_view text(message, static_cast<size_t>(length));
  if (type == GL_DEBUG_TYPE_ERROR) {
    spdlog::error("gl: {}", text);
  } else {
    spdlog::debug("gl: {}", text);
  }
}

bool contains_any_case(const std::string& text, const char* part) { return strcasestr(text.c_str(), part) != nullptr; }

std::optional<size_t> parse_index(std::string_view text) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return index;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Context>> Context::create(const ContextOptions& options) {
  std::vector<Candidate> candidates = list_candidates();
  const std::optional<size_t> wanted_index = parse_index(options.device);
  std::string refused;
  if (wanted_index.has_value()) {
    if (*wanted_index >= candidates.size()) {
      return base::field_error(absl::StatusCode::kNotFound,
                               {"device", options.device, fmt::format("below {}", candidates.size())});
    }
    candidates = {candidates[*wanted_index]};
  } else if (options.device.empty()) {
    std::stable_partition(candidates.begin(), candidates.end(), [](const Candidate& c) { return !c.software; });
  }

  for (const Candidate& candidate : candidates) {
    const auto refuse = [&](std::string_view why) { refused += fmt::format("; {}: {}", candidate.label, why); };
    if (candidate.display == EGL_NO_DISPLAY || !eglInitialize(candidate.display, nullptr, nullptr)) {
      refuse("does not initialise");
      continue;
    }
    if (!eglBindAPI(EGL_OPENGL_API)) {
      refuse("has no desktop OpenGL");
      continue;
    }
    EGLContext context = EGL_NO_CONTEXT;
    bool robust = false;
    for (const auto& [minor, with_robustness] : {std::pair{5, true}, {5, false}, {3, true}, {3, false}}) {
      context = make_context(candidate.display, minor, with_robustness);
      robust = with_robustness;
      if (context != EGL_NO_CONTEXT) break;
    }
    if (context == EGL_NO_CONTEXT) {
      refuse("gives no core context of 4.3 or better");
      continue;
    }
    auto made = std::unique_ptr<Context>(new Context(candidate.display, context));
    made->robust_ = robust;
    made->describe(candidate.label);
    if (!options.device.empty() && !wanted_index.has_value() &&
        !contains_any_case(made->info_.renderer, options.device.c_str())) {
      refuse(fmt::format("is {}", made->info_.renderer));
      continue;
    }
    const std::string why = options.device.empty()
                                ? (made->info_.software ? "no GPU gave a context" : "the first GPU that gave a context")
                                : fmt::format("asked for by \"{}\"", options.device);
    made->info_.reason += fmt::format(", {}{}", why, refused);
    return made;
  }
  if (!options.device.empty() && !wanted_index.has_value()) {
    return absl::NotFoundError(fmt::format("device: no renderer's name contains \"{}\"{}", options.device, refused));
  }
  return absl::UnavailableError(fmt::format("no OpenGL context: EGL offers {} devices{}", candidates.size(), refused));
}

void Context::describe(std::string reason) {
  info_.renderer = gl_string(GL_RENDERER);
  info_.vendor = gl_string(GL_VENDOR);
  info_.version = gl_string(GL_VERSION);
  info_.software = contains_any_case(info_.renderer, "llvmpipe") || contains_any_case(info_.renderer, "softpipe") ||
                   contains_any_case(info_.renderer, "swrast");
  info_.reason = std::move(reason);
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageCallback(log_debug_message, nullptr);
}

Context::~Context() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

absl::Status Context::take_errors() {
  if (robust_ && glGetGraphicsResetStatus() != GL_NO_ERROR) return absl::UnavailableError("the GL context was lost");
  absl::Status status;
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
    if (error == GL_OUT_OF_MEMORY) {
      status = absl::ResourceExhaustedError("the renderer ran out of memory");
    } else if (status.ok()) {
      status = absl::InternalError(fmt::format("GL error {:#06x}", error));
    }
  }
  return status;
}

}  // namespace diaphane::gl

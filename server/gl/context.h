// An OpenGL context without a display.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace diaphane::gl {

struct ContextOptions {
  /// Empty: the first GPU, else software. A number: that EGL device. Otherwise part of a renderer's name, any case.
  std::string device;
};

struct ContextInfo {
  std::string renderer;
  std::string vendor;
  std::string version;
  bool software = false;
  std::string reason;  ///< how this context was found, and why this one
};

/// A core profile of at least 4.3 (4.5 where offered), current on the thread that made it, and used there only.
/// Resets are reported where the driver offers robustness; debug output goes to the log.
class Context {
 public:
  /// Errors: NOT_FOUND no device matches `options.device`; UNAVAILABLE no EGL device gives a context (each reason
  /// named).
  static absl::StatusOr<std::unique_ptr<Context>> create(const ContextOptions& options);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const ContextInfo& info() const { return info_; }

  /// OK; RESOURCE_EXHAUSTED when the driver ran out of memory since the last call; INTERNAL for any other GL error;
  /// UNAVAILABLE when the context was lost.
  absl::Status take_errors();

 private:
  Context(void* display, void* context) : display_(display), context_(context) {}
  void describe(std::string reason);

  void* display_;  // EGLDisplay
  void* context_;  // EGLContext
  ContextInfo info_;
  bool robust_ = false;
};

}  // namespace diaphane::gl

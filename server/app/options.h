// The command line of diaphane-server.
#pragma once

#include <string>
#include <variant>

#include "absl/time/time.h"
#include "app/server.h"
#include "render/gl_renderer.h"

namespace diaphane::app {

struct Options {
  ServerOptions server;
  render::GlRendererOptions renderer;
  std::string log_level = "info";
  absl::Duration drain = absl::Seconds(10);
  bool exit_with_stdin = false;
};

inline constexpr int kUsageError = 2;

/// The options, or the exit code after --help, --version (0) or a usage error (2), which it has printed.
std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace diaphane::app

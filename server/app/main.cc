#include <cstdio>

#include "app/options.h"
#include "app/process.h"
#include "app/server.h"
#include "app/stop_request.h"
#include "app/version.h"
#include "base/log.h"
#include "render/gl_renderer.h"

namespace diaphane::app {
namespace {

int run(const Options& options) {
  base::set_log_level(options.log_level);
  log_library_messages();
  raise_file_limit();
  keep_freed_memory();
  auto server = Server::start(options.server, [&] { return render::make_gl_renderer(options.renderer); });
  if (!server.ok()) {
    std::fprintf(stderr, "diaphane-server: %s\n", std::string(server.status().message()).c_str());
    const bool misused = absl::IsInvalidArgument(server.status()) || absl::IsFailedPrecondition(server.status());
    return misused ? kUsageError : 1;
  }
  const render::RendererInfo& renderer = (*server)->renderer();
  spdlog::info("ready version={} address={} renderer=\"{}\" reason=\"{}\"", kVersion, (*server)->address(),
               renderer.gl_renderer, renderer.reason);
  std::printf("listening on %s\n", (*server)->address().c_str());
  std::fflush(stdout);
  spdlog::info("stopping reason=\"{}\"", wait_for_stop(options.exit_with_stdin));
  (*server)->stop(options.drain);
  spdlog::info("stopped");
  return 0;
}

}  // namespace
}  // namespace diaphane::app

int main(int argc, char** argv) {
  diaphane::app::block_stop_signals();
  const auto parsed = diaphane::app::parse_options(argc, argv);
  if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
  return diaphane::app::run(std::get<diaphane::app::Options>(parsed));
}

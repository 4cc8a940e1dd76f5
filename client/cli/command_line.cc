#include "command_line.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "render_arguments.h"
#include "render_command.h"
#include "sequence_command.h"
#include "server_commands.h"
#include "stream_command.h"
#include "view_command.h"

namespace diaphane::cli {
namespace {

struct Commands {
  CLI::App app{"Renders translucent objects on a Diaphane server."};
  GlobalOptions global;
  RenderArguments render_arguments;
  SequenceArguments sequence_arguments;
  StreamArguments stream_arguments;
  ViewArguments view_arguments;
  std::string scene_id;
  CLI::App* render = nullptr;
  CLI::App* sequence = nullptr;
  CLI::App* stream = nullptr;
  CLI::App* view = nullptr;
  CLI::App* materials = nullptr;
  CLI::App* info = nullptr;
  CLI::App* health = nullptr;
  CLI::App* scene = nullptr;
  CLI::App* scene_ls = nullptr;
  CLI::App* scene_show = nullptr;
  CLI::App* scene_rm = nullptr;

  Commands() {
    app.name("diaphane");
    app.set_version_flag("--version", DIAPHANE_VERSION);
    app.add_option("--server", global.server, "HOST:PORT or unix:PATH (default: a private server)")->type_name("ADDR");
    app.add_flag("--json", global.json, "Machine-readable output");
    app.add_flag("-v,--verbose", global.verbose, "Say more on stderr");
    app.require_subcommand(0, 1);  // run() says better what is missing

    render = app.add_subcommand("render", "Render meshes, or a scene file, to an image");
    add_render_options(*render, render_arguments);
    sequence = app.add_subcommand("sequence",
                                  "Render a motion, picture by picture, or to a movie; goes on where it was stopped");
    add_sequence_options(*sequence, sequence_arguments);
    stream = app.add_subcommand("stream", "Deform a body in real time, and keep the frames that come of it");
    add_stream_options(*stream, stream_arguments);
    view = app.add_subcommand("view", "Show a scene in the terminal, turned by keys, still or moving");
    add_view_options(*view, view_arguments);
    materials = app.add_subcommand("materials", "List the material presets");
    info = app.add_subcommand("info", "Say what the server is, and what it allows");
    health = app.add_subcommand("health", "Say whether a running server serves; exits with 3 if not");
    scene = app.add_subcommand("scene", "Look after the scenes of a running server");
    scene->require_subcommand(0, 1);
    scene_ls = scene->add_subcommand("ls", "List them");
    scene_show = scene->add_subcommand("show", "Show one and all that is in it");
    scene_rm = scene->add_subcommand("rm", "Delete one");
    for (CLI::App* command : {scene_show, scene_rm}) command->add_option("ID", scene_id)->required();
    for (CLI::App* command :
         {render, sequence, stream, view, materials, info, health, scene, scene_ls, scene_show, scene_rm})
      command->fallthrough();
  }

  absl::Status run() const {
    if (render->parsed()) return run_render(global, render_arguments);
    if (sequence->parsed()) return run_sequence(global, sequence_arguments, job_options(*sequence));
    if (stream->parsed()) return run_stream(global, stream_arguments);
    if (view->parsed()) return run_view(global, view_arguments);
    if (materials->parsed()) return run_materials(global);
    if (info->parsed()) return run_info(global);
    if (health->parsed()) return run_health(global);
    if (scene_ls->parsed()) return run_scene_ls(global);
    if (scene_show->parsed()) return run_scene_show(global, scene_id);
    if (scene_rm->parsed()) return run_scene_rm(global, scene_id);
    if (scene->parsed()) return usage_error("scene", "give one of ls, show ID, rm ID");
    return usage_error(
        "COMMAND", "give one of render, sequence, stream, view, materials, info, health, scene; see diaphane --help");
  }
};

void print_usage_error(std::string_view what) { print_note(fmt::format("{} (see diaphane --help)", what)); }

}  // namespace

ExitCode run_command_line(int argc, const char* const* argv, std::stop_token stop) {
  Commands commands;
  commands.global.stop = std::move(stop);
  try {
    commands.app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    commands.app.exit(request);
    return kExitOk;
  } catch (const CLI::RequiredError& error) {
    // A flag mistyped is why one is missing, more often than not.
    const std::vector<std::string> unknown = commands.app.remaining(true);
    print_usage_error(unknown.empty() ? error.what() : CLI::ExtrasError(unknown).what());
    return kExitUsage;
  } catch (const CLI::ParseError& error) {
    print_usage_error(error.what());
    return kExitUsage;
  }
  absl::Status status = commands.run();
  if (status.ok() && std::fflush(stdout) != 0) {
    status = with_exit_code(absl::DataLossError("stdout: cannot be written"), kExitFile);
  }
  if (!status.ok()) print_error(status);
  return exit_code_of(status);
}

}  // namespace diaphane::cli

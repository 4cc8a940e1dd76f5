#include "view_arguments.h"

#include "fmt/format.h"

namespace diaphane::cli {

void add_view_options(CLI::App& command, ViewArguments& arguments) {
  add_loop_options(command, arguments.loop);
  command
      .add_option_function<std::string>(
          "--protocol",
          [&](const std::string& name) {
            arguments.protocol = picture_protocol_of(name);
            if (!arguments.protocol) {
              throw CLI::ValidationError("--protocol",
                                         fmt::format("must be {}, got '{}'", picture_protocol_names(), name));
            }
          },
          "Of the terminal's pictures: " + picture_protocol_names() + " (default: by its name)")
      ->type_name("NAME");
  add_scene_options(command, arguments.render);
  command.footer(
      "Arrows turn, + and - go nearer and away, 0 goes back, the space bar stops what moves, q ends.\n"
      "Pictures fill the terminal: --size does not go with it.");
}

}  // namespace diaphane::cli

#include "view_arguments.h"

#include "fmt/format.h"

namespace diaphane::cli {

void add_view_options(CLI::App& command, ViewArguments& arguments) {
  auto* morph = command.add_option("--morph", arguments.morph, "The meshes become their bounding sphere, and back");
  auto* animation = command.add_option("--animation", arguments.animation,
                                       "An animation of a glTF file, over and over: its name, or its number from 0");
  morph->type_name("sphere")->check(CLI::IsMember({"sphere"}))->excludes(animation);
  animation->type_name("NAME");
  command.add_option("--fps", arguments.edits_per_second, "Of what moves, poses a second (default: 30)")
      ->type_name("F")
      ->check(CLI::Range(0.1, 240.0));
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

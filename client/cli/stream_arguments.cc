#include "stream_arguments.h"

#include "fmt/format.h"

namespace diaphane::cli {

void add_stream_options(CLI::App& command, StreamArguments& arguments) {
  add_loop_options(command, arguments.loop);
  command.add_option("--seconds", arguments.seconds, "How long (default: the animation once, or 4)")
      ->type_name("S")
      ->check(CLI::Range(0.01, 86400.0));
  command
      .add_option("-o,--output", arguments.output,
                  "A folder for frames, a movie (.mp4, of every edit), a bare video (.h264), or - for stdout")
      ->type_name("DIR|FILE|-")
      ->required();
  command
      .add_option_function<std::string>(
          "--encoding",
          [&](const std::string& name) {
            if (name == "h264") {
              arguments.format = ImageFormat::kH264;
              return;
            }
            const std::optional<ImageFormat> format = format_of("frame." + name);
            if (!format || *format == ImageFormat::kExr) {
              throw CLI::ValidationError("--encoding", fmt::format("must be jpg, png, webp or h264, got '{}'", name));
            }
            arguments.format = *format;
          },
          "Of frames: jpg, png, webp or h264 (default: jpg)")
      ->type_name("NAME");
  command.add_option("--picture-quality", arguments.quality, "Of jpg and webp, 1 to 100 (default: 80)")
      ->check(CLI::Range(1, 100));
  command.add_option("--bitrate", arguments.bits_per_second, "Of h264, bits a second (default: 4000000)");
  command.add_flag("--every-revision", arguments.every_revision,
                   "A frame of each edit, none passed over, after one of the scene at rest");
  command.add_flag("--compress", arguments.compress, "Positions go compressed");
  add_scene_options(command, arguments.render);
}

}  // namespace diaphane::cli

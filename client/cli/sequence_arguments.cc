#include "sequence_arguments.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "fmt/format.h"

namespace diaphane::cli {
namespace {

constexpr uint32_t kMostFrames = 100'000;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::optional<uint32_t> parse_number(std::string_view text) {
  uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

uint32_t frame_count(const std::string& flag, const std::string& text) {
  const std::optional<uint32_t> frames = parse_number(text);
  if (frames && *frames >= 1 && *frames <= kMostFrames) return *frames;
  throw CLI::ValidationError(flag, fmt::format("must be 1 to {} frames, got '{}'", kMostFrames, text));
}

Shard parse_shard(const std::string& text) {
  const size_t slash = text.find('/');
  const auto index = parse_number(std::string_view(text).substr(0, slash));
  const auto count = slash == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(slash + 1));
  if (index && count && *index >= 1 && *index <= *count) return {*index, *count};
  throw CLI::ValidationError("--shard", fmt::format("must be I/N with I from 1 to N, got '{}'", text));
}

}  // namespace

void add_sequence_options(CLI::App& command, SequenceArguments& arguments) {
  MotionArguments& motion = arguments.motion;
  auto* turntable = command.add_option_function<std::string>(
      "--turntable", [&](const std::string& text) { motion.turntable_frames = frame_count("--turntable", text); },
      "The camera goes once round, in so many frames");
  auto* morph = command.add_option_function<std::vector<std::string>>(
      "--morph",
      [&](const std::vector<std::string>& words) {
        if (words[0] != "sphere")
          throw CLI::ValidationError("--morph", fmt::format("must be sphere N, got '{}'", words[0]));
        motion.morph_frames = frame_count("--morph sphere", words[1]);
      },
      "The meshes become their bounding sphere, in so many frames");
  auto* animation = command.add_option("--animation", motion.animation,
                                       "An animation of a glTF file: its name, or its number from 0");
  turntable->type_name("N")->excludes(morph)->excludes(animation);
  morph->type_name("sphere N")->expected(2)->excludes(animation);
  animation->type_name("NAME");
  command.add_option("--fps", motion.frames_per_second, "Frames a second of an animation and of a movie (default: 24)")
      ->type_name("F")
      ->check(CLI::Range(0.1, 120.0));
  command
      .add_option_function<std::string>(
          "-o,--output",
          [&](const std::string& path) {
            arguments.output = path;
            arguments.is_movie = lower_extension(path) == ".mp4" || lower_extension(path) == ".webp";
          },
          "A folder for pictures, or a movie: .mp4 or .webp")
      ->type_name("DIR|FILE")
      ->required();
  command
      .add_option_function<std::string>(
          "--format",
          [&](const std::string& name) {
            arguments.picture_format = format_of("frame." + name);
            if (!arguments.picture_format) {
              throw CLI::ValidationError("--format", fmt::format("must be png, jpg, webp or exr, got '{}'", name));
            }
          },
          "Of pictures in a folder: png, jpg, webp or exr (default: png)")
      ->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--shard", [&](const std::string& text) { arguments.shard = parse_shard(text); },
          "Make every N-th frame from the I-th on; others make the rest of the same folder")
      ->type_name("I/N");
  add_scene_options(command, arguments.render);
}

std::string job_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || name == "--output" || name == "--shard" || name == "--help") continue;
    text += fmt::format("{}={}\n", name, fmt::join(option->results(), " "));
  }
  return text;
}

}  // namespace diaphane::cli

// Options of the commands that make many frames.
#pragma once

#include <optional>
#include <string>

#include "CLI/CLI.hpp"
#include "motion.h"
#include "render_arguments.h"

namespace diaphane::cli {

/// Every count-th frame from index on; the first shard has the index 1.
struct Shard {
  uint32_t index = 1;
  uint32_t count = 1;
  bool has(uint32_t frame) const { return frame % count == index - 1; }
};

struct SequenceArguments {
  RenderArguments render;
  MotionArguments motion;
  std::string output;
  bool is_movie = false;  ///< by the output's extension: .mp4 or .webp; else it is a folder
  std::optional<ImageFormat> picture_format;
  std::optional<Shard> shard;
};

/// Declares the options of `sequence` on `command`; see add_scene_options().
void add_sequence_options(CLI::App& command, SequenceArguments& arguments);

/// The options that frames depend on, each once, in the order in which they are declared.
std::string job_options(const CLI::App& command);

}  // namespace diaphane::cli

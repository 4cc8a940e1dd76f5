// Options of diaphane stream.
#pragma once

#include <optional>
#include <string>

#include "CLI/CLI.hpp"
#include "motion.h"
#include "render_arguments.h"

namespace diaphane::cli {

struct StreamArguments {
  RenderArguments render;
  LoopArguments loop;
  std::optional<double> seconds;
  std::string output;  ///< a folder, .mp4, .h264, or "-"
  ImageFormat format = ImageFormat::kJpeg;
  uint32_t quality = 80;
  uint32_t bits_per_second = 4'000'000;
  bool every_revision = false;
  bool compress = false;
};

/// Declares the options of `stream` on `command`; see add_scene_options().
void add_stream_options(CLI::App& command, StreamArguments& arguments);

}  // namespace diaphane::cli

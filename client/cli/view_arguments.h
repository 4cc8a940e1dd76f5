// Options of diaphane view.
#pragma once

#include <optional>

#include "CLI/CLI.hpp"
#include "motion.h"
#include "render_arguments.h"
#include "terminal_picture.h"

namespace diaphane::cli {

struct ViewArguments {
  RenderArguments render;
  LoopArguments loop;
  std::optional<PictureProtocol> protocol;  ///< not given: by the terminal
};

/// Declares the options of `view` on `command`; see add_scene_options().
void add_view_options(CLI::App& command, ViewArguments& arguments);

}  // namespace diaphane::cli

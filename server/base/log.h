// The process's log: one line an event on stderr, key=value pairs after the message.
#pragma once

#include <string_view>

#include "spdlog/spdlog.h"

namespace diaphane::base {

/// Sets the level ("error", "warning", "info", "debug") for the whole process. Thread-safe; call once from main.
void set_log_level(std::string_view level);

}  // namespace diaphane::base

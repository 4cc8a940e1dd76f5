#pragma once

namespace diaphane::app {

inline constexpr char kVersion[] = DIAPHANE_VERSION;

}  // namespace diaphane::app

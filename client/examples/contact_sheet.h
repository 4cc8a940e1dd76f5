// All frames on one page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace diaphane::examples {

/// Reads the PNG files, shrinks each to at most `cell_px` a side, lays them out in rows over a dark grey background and
/// writes `output`. Returns what went wrong, or nothing.
std::string write_contact_sheet(const std::vector<std::filesystem::path>& frames, uint32_t cell_px,
                                const std::filesystem::path& output);

}  // namespace diaphane::examples

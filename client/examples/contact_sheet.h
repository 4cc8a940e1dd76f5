// All frames on one page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace diaphane::examples {

/// Reads the PNG files, shrinks each to at most `cell_px` a side, lays them out in rows of eight over a dark grey
/// background, each series on rows of its own, and writes `output`. Returns what went wrong, or nothing.
std::string write_contact_sheet(const std::vector<std::vector<std::filesystem::path>>& series, uint32_t cell_px,
                                const std::filesystem::path& output);

}  // namespace diaphane::examples

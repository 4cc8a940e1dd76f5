// Geomview's Object File Format, as text.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Whether `text` begins with an OFF keyword (OFF, COFF, NOFF, CNOFF, STOFF, ...).
bool looks_like_off(std::string_view text);

/// Reads positions, normals (N), colours (C), texture coordinates (ST) and faces; one mesh. One vertex or face per
/// line. Colours of faces are passed over. kUnimplemented: 4OFF and nOFF (points of other dimensions) and binary OFF.
/// Errors: read_mesh_file().
absl::StatusOr<LoadedFile> read_off(std::string_view text, const Source& source);

}  // namespace diaphane::readers

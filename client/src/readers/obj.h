// Wavefront OBJ.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Reads `v` with its colour, `vt`, `vn` and `f`; one mesh. A vertex whose faces give it several normals or texture
/// coordinates is copied once for each further pair (appended, in the order of the faces). Free-form surfaces, lines,
/// points, groups and materials are passed over. Indices may be negative, and may refer to lines that follow. Errors:
/// read_mesh_file().
absl::StatusOr<LoadedFile> read_obj(std::string_view text, const Source& source);

}  // namespace diaphane::readers

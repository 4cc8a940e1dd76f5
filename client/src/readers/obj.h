// Wavefront OBJ.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Reads `v`, `vn` and `f`; one mesh. A vertex whose faces give it several normals is copied once for each further one
/// (appended, in the order of the faces); texture coordinates part nothing. Free-form surfaces, lines, points, groups
/// and materials are passed over. Indices may be negative, and may refer to lines that follow. Errors:
/// read_mesh_file().
absl::StatusOr<LoadedFile> read_obj(std::string_view text, const Source& source);

}  // namespace diaphane::readers

// PLY, the Stanford polygon format.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Reads ASCII and binary PLY of either byte order; one mesh. Taken: x y z, nx ny nz, red green blue and s t (or u v,
/// or texture_u texture_v) of element vertex, in any order and of any type; list vertex_indices or vertex_index of
/// element face (polygons) or tristrips (-1 ends a strip). Everything else is passed over. kUnimplemented: faces before
/// vertices. Errors: read_mesh_file().
absl::StatusOr<LoadedFile> read_ply(std::string_view bytes, const Source& source);

}  // namespace diaphane::readers

// STL, binary and ASCII.
#pragma once

#include <string_view>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Whether `bytes` are as long as the triangle count at byte 80 says: what tells a binary file, even one that begins
/// with "solid".
bool is_binary_stl(std::string_view bytes);

/// Whether `bytes` begin like ASCII STL: "solid" with a facet or an end after it.
bool looks_like_ascii_stl(std::string_view bytes);

/// Reads either kind. Corners at bit-equal positions become one vertex (-0 as 0), because STL says in no other way
/// where the surface is connected; facet normals are passed over. ASCII: a mesh per solid. Errors: read_mesh_file().
absl::StatusOr<LoadedFile> read_stl(std::string_view bytes, const Source& source);

}  // namespace diaphane::readers

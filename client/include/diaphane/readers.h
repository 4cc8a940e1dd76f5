// Meshes from files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"

namespace diaphane {

/// Bounds on what a file may make the reader allocate; counts are over the whole file.
struct ReadLimits {
  uint64_t max_file_bytes = uint64_t{2} << 30;  ///< of the file itself and of each file that it refers to
  uint64_t max_vertices = 50'000'000;
  uint64_t max_triangles = 100'000'000;
  uint64_t max_nodes = 100'000;  ///< of a glTF scene graph
};

struct LoadedFile {
  std::vector<MeshData> meshes;
  std::optional<double> millimetres_per_unit;  ///< where the format states a unit (glTF: metres, so 1000)
  std::vector<std::string> warnings;           ///< one line each: what was left out, and why
};

/// Reads a glTF (.gltf, .glb), Wavefront OBJ (.obj) or PLY (.ply) file. Polygons come back as triangles; what cannot be
/// a mesh is refused as a whole, never half read. Nothing outside the file's own folder is opened.
///
/// Errors, each one line that starts with the path: NOT_FOUND no such file; PERMISSION_DENIED it cannot be opened;
/// INVALID_ARGUMENT it is not a well-formed file of a known kind, or holds no triangle; RESOURCE_EXHAUSTED it is past
/// one of `limits`. Thread-safe.
absl::StatusOr<LoadedFile> read_mesh_file(const std::filesystem::path& path, const ReadLimits& limits = {});

}  // namespace diaphane

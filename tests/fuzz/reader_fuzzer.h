// What every reader promises, whatever the bytes.
#pragma once

#include <cmath>
#include <cstdint>

#include "readers/source.h"
#include "tests/fuzz/promises.h"

namespace diaphane::fuzz {

/// Bounds under which one run stays quick and small.
inline readers::Source fuzzed_source() {
  readers::Source source;
  source.name = "fuzzed";
  source.limits.max_file_bytes = uint64_t{1} << 20;
  source.limits.max_vertices = 100'000;
  source.limits.max_triangles = 100'000;
  source.limits.max_nodes = 1000;
  return source;
}

inline bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Aborts unless `file` is a refusal in one line or meshes that can be rendered.
inline void check_promises(const absl::StatusOr<LoadedFile>& file, const ReadLimits& limits) {
  if (!file.ok()) {
    require(file.status().message().find('\n') == absl::string_view::npos, "one line");
    require(file.status().message().substr(0, 6) == "fuzzed", "a message that names the file");
    return;
  }
  require(!file->meshes.empty(), "a mesh");
  uint64_t vertices = 0, triangles = 0;
  for (const MeshData& mesh : file->meshes) {
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size() / 3;
    require(!mesh.triangles.empty() && mesh.triangles.size() % 3 == 0, "whole triangles");
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal per position");
    require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size(), "a colour per position");
    require(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == mesh.positions.size(),
            "a texture coordinate per position");
    for (const Rgb& colour : mesh.colors) {
      for (const float channel : {colour.r, colour.g, colour.b})
        require(channel >= 0 && channel <= 1, "colours of 0..1");
    }
    for (const TextureCoordinate& coordinate : mesh.texture_coordinates) {
      require(std::isfinite(coordinate.u) && std::isfinite(coordinate.v), "finite texture coordinates");
    }
    for (uint32_t index : mesh.triangles) require(index < mesh.positions.size(), "indices in range");
    for (const Vec3& position : mesh.positions) require(is_finite(position), "finite positions");
    for (const Vec3& normal : mesh.normals) require(is_finite(normal), "finite normals");
    for (float value : mesh.scene_from_mesh) require(std::isfinite(value), "a finite transform");
  }
  require(vertices <= limits.max_vertices && triangles <= limits.max_triangles, "the limits");
  require(file->meshes.size() <= limits.max_nodes, "the limit of meshes");
}

}  // namespace diaphane::fuzz

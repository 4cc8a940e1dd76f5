// Which vertex a corner of an OBJ face is, where faces give positions normals and texture coordinates of their own.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "readers/mesh_builder.h"

namespace diaphane::readers {

/// Texture coordinate of an OBJ file, counted from the lower left corner.
struct ObjTextureCoordinate {
  double u = 0;
  double v = 0;
};

/// Gives each corner its vertex: that of its position where what it names beside fits, else a copy. Not thread-safe.
/// What it is made from outlives it, and may grow until the first corner.
class ObjVertices {
 public:
  struct Corner {
    uint32_t position = 0;
    int32_t texture = -1;  ///< from 0; -1: none
    int32_t normal = -1;   ///< from 0; -1: none
  };

  ObjVertices(const std::vector<Double3>& normals, const std::vector<ObjTextureCoordinate>& textures,
              MeshBuilder& builder)
      : normals_(normals), textures_(textures), builder_(builder) {}

  /// The vertex of `corner`, whose indices are in range. kResourceExhausted where a copy is past the limits.
  absl::StatusOr<uint32_t> vertex_of(const Corner& corner);

 private:
  using Names = std::array<int32_t, 2>;  // of texture coordinate and normal

  bool take(uint32_t vertex, const Names& wanted, Names& has);

  const std::vector<Double3>& normals_;
  const std::vector<ObjTextureCoordinate>& textures_;
  MeshBuilder& builder_;
  std::vector<Names> names_of_vertex_;
  absl::flat_hash_map<std::array<int32_t, 3>, uint32_t> copies_;  // by position, texture coordinate and normal
};

}  // namespace diaphane::readers

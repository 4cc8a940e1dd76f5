// A triangle mesh as plain arrays, whatever it was read from or made by.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diaphane/values.h"

namespace diaphane {

/// A triangle mesh. Two vertices at bit-equal positions are the same place: the surface is connected there.
struct MeshData {
  std::string name;             ///< for messages only; may be empty
  std::vector<Vec3> positions;  ///< mesh units
  std::vector<Vec3> normals;    ///< empty (computed by the server), or one per position, of any length
  std::vector<Rgb> colors;      ///< empty, or one per position: linear RGB, 0..1
  std::vector<TextureCoordinate> texture_coordinates;  ///< empty, or one per position
  std::vector<uint32_t> triangles;  ///< three indices into `positions` per triangle, counter-clockwise from outside

  /// What Deformer::set_weights() drives: per target the displacement of every position, mesh units. At most 256.
  std::vector<std::vector<Vec3>> morph_targets;

  std::optional<size_t> material;  ///< into the `materials` of the LoadedFile that it came with
  /// Mesh units to scene units: column-major 4×4, affine and invertible.
  std::array<float, 16> scene_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

}  // namespace diaphane

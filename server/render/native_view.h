// What a camera sees of meshes, rasterised natively.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "absl/functional/function_ref.h"
#include "glm/mat4x4.hpp"
#include "render/raster.h"
#include "render/surface_points.h"
#include "render/tiles.h"

namespace diaphane::render {

/// The nearest triangle in each pixel of a tile. Work is spread over all cores; the same bytes on any number of them.
class NativeView {
 public:
  /// The picture that a tile is a piece of, and from where it is seen.
  struct Picture {
    glm::mat4 clip_from_world;
    glm::vec3 eye_mm;
    uint32_t width_px, height_px;
  };

  /// One thread calls; memory is kept from call to call.
  void draw(const Picture& picture, const Tile& tile, std::span<const RasterMesh> meshes);

  /// Calls shade(index of a mesh, its points) until every pixel that shows one has come, from several threads at once.
  /// The points' cells are the tile's pixels, rows bottom to top. `meshes` are those that were drawn; only their values
  /// may be others.
  void for_each_batch(std::span<const RasterMesh> meshes,
                      absl::FunctionRef<void(size_t mesh, const PointBatch& points)> shade) const;

 private:
  /// A vertex on the raster; nearness, 1/w, is below 0 where triangles have to be clipped.
  struct Corner {
    RasterPoint at;
    float nearness;
  };

  Corner place(const glm::vec4& clip) const;
  void place_vertices(const RasterMesh& mesh);
  void see(const RasterMesh& mesh, uint32_t first_triangle, size_t begin, size_t end);
  void see_triangle(const RasterMesh& mesh, const Corner& a, const Corner& b, const Corner& c, uint32_t index);
  void see_clipped(const RasterMesh& mesh, const glm::uvec3& triangle, uint32_t index);
  size_t mesh_of(uint32_t triangle) const;

  Picture picture_{};
  Tile tile_{};
  std::vector<uint32_t> first_triangles_;  ///< of each mesh, and the end
  std::vector<Corner> corners_;            ///< of one mesh
  bool clips_ = false;                     ///< some of them have triangles to clip
  std::vector<uint64_t> seen_;             ///< visible_key()s, [row][column]
};

}  // namespace diaphane::render

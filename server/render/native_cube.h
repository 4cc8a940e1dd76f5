// The paper's cube map in plain memory: what CubeAtlas is on a GPU.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/cube_atlas.h"
#include "render/surface_points.h"

namespace diaphane::render {

/// Texels of six faces, each within a border of nothing one texel wide, rows bottom to top. See shaders/atlas.frag.
class NativeCube {
 public:
  /// E (RGB); the self-occlusion key; N along u and v; depth over the box centre in mm; coverage.
  static constexpr int kFloatsPerTexel = 8;
  static constexpr int kFaces = 6;

  /// Pass 1, spread over all cores: the same bytes on any number of them. `mesh.values`: E with shadows at the
  /// vertices, instead of the lights'. One thread calls; memory is kept while the face size is the same.
  void draw(const AtlasKey& key, const BoxUniforms& box, const RasterMesh& mesh);

  const AtlasKey& key() const { return key_; }
  const BoxUniforms& box() const { return box_; }
  int size_px() const { return size_px_; }
  /// Texels from one row to the next, and from one face to the next.
  int row_texels() const { return size_px_ + 2; }
  int face_texels() const { return row_texels() * row_texels(); }
  /// Texel (x, y) of a face is at kFloatsPerTexel · (face·face_texels() + (y + 1)·row_texels() + x + 1).
  const float* texels() const { return texels_.data(); }
  size_t bytes() const { return texels_.capacity() * sizeof(float) + seen_.capacity() * sizeof(uint64_t); }

 private:
  struct Snapped {
    int32_t of_axis[3];  ///< 1/256 texel
  };

  void snap(std::span<const glm::vec3> positions_mm);
  void see(const RasterMesh& mesh, size_t begin, size_t end);
  void fill_rows(const RasterMesh& mesh, int face, int begin, int end);
  void store(const PointBatch& points, const RasterMesh& mesh, int face);

  AtlasKey key_;
  BoxUniforms box_;
  int size_px_ = 0;
  std::vector<Snapped> vertices_;
  std::vector<uint64_t> seen_;  ///< visible_key()s, [face][row][column]
  std::vector<float> texels_;
};

}  // namespace diaphane::render

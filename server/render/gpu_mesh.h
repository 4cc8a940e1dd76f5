// One mesh of a scene as the GPU holds it.
#pragma once

#include <memory>
#include <optional>

#include "gl/objects.h"
#include "glm/mat4x4.hpp"
#include "render/cube_atlas.h"
#include "render/stage_clock.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Follows a scene mesh from revision to revision and does again only what its changes call for. Render thread only.
class GpuMesh {
 public:
  /// Brings vertex buffers up to `mesh`. Stages: place, upload.
  void update(const scene::Mesh& mesh, double millimetres_per_unit, StageClock& clock);

  /// Draws all triangles with positions at ATTRIBUTE_POSITION and normals at ATTRIBUTE_NORMAL, in mm and world axes.
  void draw() const;

  const geometry::Bounds& bounds_mm() const { return bounds_mm_; }
  bool flipped() const { return flipped_; }
  /// Grows whenever positions or normals in millimetres change.
  uint64_t generation() const { return generation_; }
  /// The scene let go of the mesh that this one follows.
  bool orphaned() const { return topology_.expired(); }

  std::optional<CubeAtlas> atlas;

 private:
  std::weak_ptr<const geometry::MeshTopology> topology_;
  std::weak_ptr<const geometry::MeshShape> shape_;
  glm::mat4 scene_from_mesh_{0};
  double millimetres_per_unit_ = 0;

  gl::VertexArray vertex_array_;
  gl::Buffer positions_;
  gl::Buffer normals_;
  gl::Buffer indices_;
  GLsizei index_count_ = 0;
  geometry::Bounds bounds_mm_;
  bool flipped_ = false;
  uint64_t generation_ = 0;
};

}  // namespace diaphane::render

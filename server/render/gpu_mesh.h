// A placed mesh as the GPU holds it.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "geometry/shape.h"
#include "geometry/surface_attributes.h"
#include "geometry/topology.h"
#include "gl/objects.h"
#include "render/memo.h"
#include "render/stage_clock.h"

namespace diaphane::render {

/// Vertex buffers that are filled again only when what they hold changed. Render thread only.
class GpuMesh {
 public:
  /// Positions at ATTRIBUTE_POSITION and normals at ATTRIBUTE_NORMAL, mm and world axes. `generation` names `shape`'s
  /// state within `topology`. Stage: upload.
  void update(const std::shared_ptr<const geometry::MeshTopology>& topology, const geometry::PlacedShape& shape,
              uint64_t generation, StageClock& clock);

  /// Radiosity at ATTRIBUTE_RADIOSITY, one value a vertex of the last update(). Stage: upload.
  void update_radiosity(std::span<const glm::vec3> radiosity, uint64_t generation, StageClock& clock);

  /// Irradiance at ATTRIBUTE_IRRADIANCE, likewise. `source` names who counts the generations. Stage: upload.
  void update_irradiance(std::span<const glm::vec3> irradiance, const void* source, uint64_t generation,
                         StageClock& clock);

  /// Texture coordinates at ATTRIBUTE_TEXTURE_COORDINATE and colours at ATTRIBUTE_COLOR, as far as there are any;
  /// `carry` makes those of the last update()'s vertices of the mesh's own. Stage: upload.
  template <typename Carry>
  void update_attributes(const std::shared_ptr<const geometry::SurfaceAttributes>& attributes, const Carry& carry,
                         StageClock& clock) {
    if (attributes_.lock() == attributes) return clock.sleep("upload");
    clock.run("upload", [&] { fill_attributes(carry(*attributes)); });
    attributes_ = attributes;
  }

  /// Draws all triangles, or those alone that face the eye; `mirrored`: the projection turns left into right.
  void draw(bool facing_only = false, bool mirrored = false) const;

 private:
  void fill_attributes(const geometry::SurfaceAttributes& attributes);

  std::weak_ptr<const geometry::MeshTopology> topology_;
  Memo<std::pair<const geometry::PlacedShape*, uint64_t>> shape_memo_;
  Memo<uint64_t> radiosity_memo_;
  Memo<std::pair<const void*, uint64_t>> irradiance_memo_;
  gl::VertexArray vertex_array_;
  gl::Buffer positions_;
  gl::Buffer normals_;
  gl::Buffer radiosity_;
  gl::Buffer irradiance_;
  std::weak_ptr<const geometry::SurfaceAttributes> attributes_;
  gl::Buffer texture_coordinates_;
  gl::Buffer colors_;
  gl::Buffer indices_;
  GLsizei index_count_ = 0;
  bool flipped_ = false;
};

}  // namespace diaphane::render

// Draws one revision of a scene from one view: stages, then tiles.
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "render/channels.h"
#include "render/coat_layer.h"
#include "render/frame.h"
#include "render/gpu_textures.h"
#include "render/mesh_state.h"
#include "render/native_view.h"
#include "render/shading.h"
#include "render/shadow.h"
#include "render/srgb_table.h"
#include "render/tiles.h"
#include "render/view_targets.h"

namespace diaphane::render {

/// Keeps meshes, atlases and targets from frame to frame. Render thread only, with the context current.
class ScenePainter {
 public:
  /// `native`: what triangles show is found on the CPU, for techniques that have it.
  ScenePainter(Shading shading, bool native) : shading_(std::move(shading)), native_(native) {}

  /// The frame is made in the memory of `spare`. Errors: as FrameRenderer::render.
  absl::StatusOr<Frame> paint(const FrameRequest& request, const std::atomic<bool>& cancelled, Frame spare = {});
  /// Whether the last frame's triangles went without OpenGL.
  bool was_native() const { return was_native_; }

 private:
  /// What one frame's stages share.
  struct Job {
    const FrameRequest& request;
    const std::atomic<bool>& cancelled;
    ChannelNeeds needs;  ///< of the pass at hand
    PixelFormat format;  ///< that is drawn
    bool coated;
    std::vector<DrawnMesh>& meshes;  ///< the painter's, as the next
    std::vector<LightStorage>& lights;
    bool native = false;
    Variant variant{};
    geometry::Bounds bounds_mm{};
    Ambient ambient{};
    ViewUniforms view{};
    StageClock clock{};
    ChannelTile channels{};  ///< of the tile at hand
    uint32_t passes = 1;     ///< over every tile
    size_t pixels_done = 0;  ///< in earlier tiles and passes
  };

  static absl::Status check_cancelled(const Job& job);

  // scene_painter_stages.cc
  void gather_meshes(Job& job);
  void update_surface(const DrawnMesh& drawn, const RefinedMesh* refined, Job& job);
  void bound_memory(const Job& job);
  absl::Status refine(Job& job);
  void update_shadows(Job& job);
  const AtlasKey& atlas_key(const DrawnMesh& drawn, const Job& job);
  void update_atlas(const DrawnMesh& drawn, Job& job);
  void update_integral(const DrawnMesh& drawn, bool shadowed, Job& job);
  absl::Status update_lit(const DrawnMesh& drawn, bool shadowed, Job& job);
  absl::Status update_mesh(const DrawnMesh& drawn, bool shadowed, Job& job);
  absl::Status update(Job& job);

  // scene_painter.cc
  void bind_view(const Job& job, size_t mesh_index);
  static bool shows_outside_alone(const Job& job, size_t mesh_index);
  void draw_meshes(const Job& job);
  void set_viewport(const Job& job, const Tile& tile) const;
  void draw_gbuffer(Job& job, const Tile& tile);
  void draw_forward(Job& job, const Tile& tile);
  void shade_tile(Job& job, const Tile& tile);
  void read_surface(Job& job, const Tile& tile);
  void read_tile(Job& job, const Tile& tile, uint8_t* pixels);
  absl::Status draw_tile(Job& job, const Tile& tile, uint8_t* pixels);

  // scene_painter_native.cc
  RasterMesh raster_mesh(const Job& job, size_t mesh_index) const;
  void update_native_atlas(const DrawnMesh& drawn, Job& job);
  void shade_batch(const Job& job, size_t mesh_index, const PointBatch& points, EnteringLight& radiosity) const;
  void store_batch(Job& job, size_t mesh_index, const PointBatch& points, const EnteringLight& radiosity,
                   uint8_t* pixels) const;
  void store_irradiance(Job& job);
  void draw_native_tile(Job& job, const Tile& tile, uint8_t* pixels);

  // scene_painter_samples.cc
  void shift_view(Job& job, const glm::vec2& place) const;
  absl::Status draw_sampled_tile(Job& job, const Tile& tile, uint8_t* pixels);
  absl::Status draw_tiles(Job& job, Frame& frame);

  // scene_painter_reference.cc
  absl::Status draw_reference_tile(Job& job, const Tile& tile, uint8_t* pixels);

  // scene_painter_coat.cc
  static bool has_coats(const FrameRequest& request);
  void add_coats(Job& job, std::span<glm::vec4> radiance);

  Shading shading_;
  bool native_;
  bool was_native_ = false;
  NativeView view_;
  std::vector<RasterMesh> raster_meshes_;
  // Of one frame, in the memory of the last.
  std::vector<DrawnMesh> drawn_;
  std::vector<LightStorage> lights_;
  std::vector<uint8_t> tile_pixels_;
  AtlasKey atlas_key_;
  std::vector<ShadowCaster> casters_;
  std::vector<uint64_t> places_;
  SrgbTable srgb_;
  CoatLayer coats_;
  GpuTextures textures_;
  std::map<std::string, MeshState> meshes_;
  std::optional<ViewTargets> targets_;
  ShadowScene shadows_;
  Memo<std::vector<uint64_t>> shadow_reads_;  // every mesh's place
  uint64_t shadows_generation_ = 0;
};

}  // namespace diaphane::render

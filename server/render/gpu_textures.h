// Textures as the GPU holds them.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "gl/objects.h"
#include "render/stage_clock.h"
#include "scene/snapshot.h"

namespace diaphane::render {

/// Kept, mip maps included, for as long as the scene keeps their pixels. Render thread only.
class GpuTextures {
 public:
  /// Uploads those of `textures` that are not there. Stage: upload.
  void update(const scene::SceneSnapshot& scene, const scene::SurfaceTextures& textures, StageClock& clock);

  /// Binds them to UNIT_ALBEDO, UNIT_NORMAL and UNIT_ROUGHNESS: white where there is none. The last update() knew them.
  void bind(const scene::SurfaceTextures& textures);

  /// Drops those whose pixels are no more.
  void forget_orphans();

 private:
  struct Entry {
    std::weak_ptr<const scene::TexturePixels> pixels;
    gl::Texture texture;
  };

  void bind(GLuint unit, const std::string& name);

  std::map<std::string, Entry> textures_;  ///< by name, which no two ever share
  std::unique_ptr<gl::Texture> white_;
};

}  // namespace diaphane::render

// Everything that the renderer keeps of one mesh between frames.
#pragma once

#include <optional>

#include "render/cube_atlas.h"
#include "render/gpu_mesh.h"
#include "render/native_paper.h"
#include "render/placed_mesh.h"
#include "render/refined_mesh.h"
#include "render/surface_light.h"
#include "render/vertex_light.h"

namespace diaphane::render {

/// Render thread only.
struct MeshState {
  PlacedMesh placed;
  RefinedMesh refined;  ///< for the integral
  SurfaceLight light;
  RefinedMesh lit;  ///< for paper and lambert with shadows
  VertexLight vertex_light;
  GpuMesh gpu;
  std::optional<CubeAtlas> atlas;
  NativePaper native_paper;  ///< in place of `gpu` and `atlas` where the raster is native
};

/// A mesh of the frame that is being drawn.
struct DrawnMesh {
  const scene::Mesh* mesh;
  MeshState* state;
  optics::Coefficients material;
  std::optional<optics::Coat> coat;
  scene::SurfaceTextures textures;
};

}  // namespace diaphane::render

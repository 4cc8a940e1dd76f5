// The frames of a stream without the stream: the renderer called in this process.
#pragma once

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"
#include "diaphane/render_options.h"
#include "diaphane/values.h"
#include "render/frame.h"
#include "scene/snapshot.h"

namespace diaphane::bench {

/// One marble body under one point light. The thread that made the renderer.
class InProcess {
 public:
  InProcess(render::FrameRenderer& renderer, const MeshData& mesh, double millimetres_per_unit,
            const PointLight& light);

  /// Milliseconds from positions to pixels.
  absl::StatusOr<double> frame_ms(const std::vector<Vec3>& positions, const Camera& camera, const Size& size);

 private:
  render::FrameRenderer& renderer_;
  scene::SceneSnapshot scene_;
};

}  // namespace diaphane::bench

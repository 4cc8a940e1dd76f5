// The edits of a motion.
#pragma once

#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "diaphane/scene.h"
#include "diaphane/stream.h"
#include "motion.h"

namespace diaphane::cli {

/// Sends a scene's edits. One thread at a time.
class Animator {
 public:
  /// `motion` must live as long. A `to_sphere` goes there and back, by the server where there is one mesh.
  Animator(const Motion& motion, bool to_sphere, const Scene& scene, std::vector<MeshHandle> meshes,
           const DeformerOptions& options);

  /// Of the whole motion.
  uint32_t edits() const { return motion_.frame_count(); }

  /// One of them, below edits(). Errors: the file's, kExitFile; the deformer's.
  absl::Status send(uint32_t edit);

  /// Waits until all is applied; the scene's revision then.
  absl::StatusOr<uint64_t> flush() { return deformer_.flush(); }

 private:
  const Motion& motion_;
  const bool by_server_;
  const std::vector<MeshHandle> meshes_;
  Deformer deformer_;
};

}  // namespace diaphane::cli

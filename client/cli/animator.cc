#include "animator.h"

#include <cmath>
#include <utility>

#include "status.h"

namespace diaphane::cli {

Animator::Animator(const Motion& motion, bool to_sphere, const Scene& scene, std::vector<MeshHandle> meshes,
                   const DeformerOptions& options)
    : motion_(motion),
      by_server_(to_sphere && meshes.size() == 1),
      meshes_(std::move(meshes)),
      deformer_(scene.deform(options)) {}

absl::Status Animator::send(uint32_t edit) {
  if (by_server_) {
    const double there_and_back = 0.5 - 0.5 * std::cos(2 * M_PI * edit / edits());
    return deformer_.morph_to_sphere(meshes_.front(), static_cast<float>(there_and_back));
  }
  const absl::StatusOr<std::vector<MeshPose>> poses = motion_.poses(edit);
  if (!poses.ok()) return with_exit_code(poses.status(), kExitFile);
  deformer_.begin();
  for (size_t i = 0; i < poses->size(); ++i) {
    absl::Status sent = deformer_.set_positions(meshes_[i], (*poses)[i].positions);
    if (!sent.ok()) return sent;
  }
  return deformer_.commit();
}

}  // namespace diaphane::cli

// A plan on a server.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "progress.h"
#include "render_plan.h"

namespace diaphane::cli {

/// A scene that is deleted again, whatever happens.
class TemporaryScene {
 public:
  /// Settles what of `plan` only the server knows. Errors: the client's; kExitRejected for an unknown preset.
  static absl::StatusOr<TemporaryScene> create(const Client& client, RenderPlan* plan);
  ~TemporaryScene();
  TemporaryScene(TemporaryScene&& other) noexcept;
  TemporaryScene& operator=(TemporaryScene&&) = delete;

  /// Not after remove().
  const Scene& scene() const { return *scene_; }
  /// Deletes it, and says how that went. Once.
  absl::Status remove();

 private:
  explicit TemporaryScene(Scene scene) : scene_(std::move(scene)) {}

  std::optional<Scene> scene_;
};

/// Uploads all of `plan`. The meshes, in its order.
absl::StatusOr<std::vector<MeshHandle>> fill_scene(const Scene& scene, const RenderPlan& plan, Progress& progress);

}  // namespace diaphane::cli

// A plan on a server.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/client.h"
#include "progress.h"
#include "render_plan.h"
#include "session.h"

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

/// What a plan became. The scene is gone before the server is.
struct UploadedScene {
  Session session;
  TemporaryScene scene;
  std::vector<MeshHandle> meshes;  ///< in the plan's order
};

/// Connects, or starts a server, and uploads all of `plan`. Errors: as of open_session() and TemporaryScene::create().
absl::StatusOr<UploadedScene> upload_plan(const GlobalOptions& global, RenderPlan* plan, Progress& progress);

}  // namespace diaphane::cli

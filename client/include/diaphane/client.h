// A connection to a Diaphane server.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/scene.h"
#include "diaphane/values.h"

namespace diaphane {

struct ClientOptions {
  /// How long connect(), and each call after it, goes on trying to reach a server that does not answer.
  std::chrono::milliseconds connect_timeout{5'000};
  /// How long one call may take altogether: uploads and renders included.
  std::chrono::milliseconds call_timeout{600'000};
  /// Once stop is requested, calls in flight and later ones end with CANCELLED; Scene::remove() still runs.
  std::stop_token stop;
};

/// What the server is, and what it allows.
struct ServerInfo {
  std::string version;
  std::string gl_renderer;
  std::string gl_vendor;
  std::string gl_version;
  bool software_rendering = false;
  std::string context_reason;  ///< how the GL context was found, and why this one

  uint64_t max_pixels = 0;            ///< of one frame
  uint64_t max_reference_pixels = 0;  ///< of one frame by the reference technique
  double max_reference_seconds = 0;   ///< that such a frame may be drawn for
  uint32_t max_vertices_per_mesh = 0;
  uint32_t max_triangles_per_mesh = 0;
  uint32_t max_scenes = 0;
  uint32_t max_meshes_per_scene = 0;
  uint32_t max_lights_per_scene = 0;
  uint32_t max_materials_per_scene = 0;
  uint64_t max_mesh_bytes = 0;  ///< of all meshes of all scenes, and of uploads in flight
  uint32_t max_chunk_bytes = 0;
  uint32_t max_queued_frames = 0;

  std::vector<std::string> image_formats;
  std::vector<std::string> techniques;
};

struct SceneOptions {
  std::string display_name;         ///< free text, at most 256 bytes
  double millimetres_per_unit = 1;  ///< size of one scene unit, 1e-6..1e6
};

/// A connection to one server. A copy is another handle to the same connection; all members may be called from any
/// number of threads at once.
///
/// Errors: every call may return UNAVAILABLE (the server does not answer; tried again, with growing pauses, for
/// ClientOptions::connect_timeout) and DEADLINE_EXCEEDED (ClientOptions::call_timeout). Calls are idempotent: those
/// that change something carry a random id by which the server knows a repeat, so that trying again is harmless.
/// INVALID_ARGUMENT names the field, the value and the range.
class Client {
 public:
  /// Connects and asks the server who it is. `address` is HOST:PORT or unix:PATH; plain text, no proxy.
  ///
  /// Errors: INVALID_ARGUMENT for an address of another form; UNAVAILABLE when nothing answers within connect_timeout;
  /// FAILED_PRECONDITION when what answers is not a Diaphane server.
  static absl::StatusOr<Client> connect(std::string_view address, const ClientOptions& options = {});

  /// What the server said of itself now.
  absl::StatusOr<ServerInfo> info() const;

  /// The materials that have names, by name.
  absl::StatusOr<std::vector<MaterialPreset>> material_presets() const;

  /// Makes an empty scene. It lives until Scene::remove(), whatever becomes of the handle.
  ///
  /// Errors: INVALID_ARGUMENT; RESOURCE_EXHAUSTED past ServerInfo::max_scenes.
  absl::StatusOr<Scene> create_scene(const SceneOptions& options = {}) const;

  /// Every scene of the server, all pages of them.
  absl::StatusOr<std::vector<SceneInfo>> scenes() const;

  /// A handle to the scene called `name`: scenes/{scene}, or {scene} alone.
  ///
  /// Errors: INVALID_ARGUMENT for a name of another form; NOT_FOUND.
  absl::StatusOr<Scene> open_scene(std::string_view name) const;

 private:
  explicit Client(std::shared_ptr<internal::Connection> connection);

  std::shared_ptr<internal::Connection> connection_;
};

/// Asks the server at `address`, by the health protocol of gRPC, whether it serves. A server that is stopping does not.
///
/// Errors: INVALID_ARGUMENT for an address of another form than connect()'s; UNAVAILABLE when it does not serve, or
/// nothing answers within connect_timeout; FAILED_PRECONDITION when what answers has no health to tell.
absl::Status check_health(std::string_view address, const ClientOptions& options = {});

}  // namespace diaphane

// A scene on a server: meshes, their materials, lights, and frames of them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "diaphane/environment.h"
#include "diaphane/mesh_data.h"
#include "diaphane/render_options.h"
#include "diaphane/stream.h"
#include "diaphane/texture.h"
#include "diaphane/values.h"

namespace diaphane {

class Client;

namespace internal {
class Connection;
}  // namespace internal

/// Names of things in a scene, as the server chose them. Plain values.
struct MaterialHandle {
  std::string name;  ///< scenes/{scene}/materials/{material}
};
struct LightHandle {
  std::string name;  ///< scenes/{scene}/lights/{light}
};
struct MeshHandle {
  std::string name;  ///< scenes/{scene}/meshes/{mesh}
};

struct SceneInfo {
  std::string name;  ///< scenes/{scene}
  std::string display_name;
  double millimetres_per_unit = 1;
  uint64_t revision = 0;  ///< grows with every change of the scene or of anything in it
  uint32_t mesh_count = 0;
  uint32_t material_count = 0;
  uint32_t light_count = 0;
  bool has_environment = false;
  uint32_t texture_count = 0;
};

struct MaterialInfo {
  MaterialHandle handle;
  Material material;
  Coefficients resolved;              ///< the coefficients in force
  std::vector<std::string> warnings;  ///< what is doubtful about them, a sentence each
};

struct LightInfo {
  LightHandle handle;
  Light light;
};

struct MeshInfo {
  MeshHandle handle;
  MaterialHandle material;
  std::array<float, 16> scene_from_mesh{};  ///< column-major
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  bool has_normals = false;  ///< given ones are in force; else they are computed
  uint64_t positions_revision = 0;
  bool has_texture_coordinates = false;
  bool has_colors = false;
};

/// The nearest point of a surface, front or back.
struct PickedPoint {
  MeshHandle mesh;
  uint32_t triangle = 0;  ///< of those that were uploaded
  Vec3 barycentric;       ///< shares of its vertices in the point; they sum to 1
  Vec3 position;          ///< scene units
  Vec3 facet_normal;      ///< unit, turned to the eye, scene axes
  double distance = 0;    ///< from the eye, scene units
  uint64_t scene_revision = 0;
};

/// A scene and all that is in it, read by several calls: not one moment's state while others change the scene.
struct SceneDescription {
  SceneInfo scene;
  std::vector<MaterialInfo> materials;
  std::vector<LightInfo> lights;
  std::vector<MeshInfo> meshes;
};

struct MeshOptions {
  MaterialHandle material;  ///< of the same scene; must be given
};

struct MeshUpdate {
  std::optional<MaterialHandle> material;
  std::optional<std::array<float, 16>> scene_from_mesh;  ///< column-major, affine, invertible
};

/// A handle to a scene. A copy is another handle to the same scene; all members may be called from any number of
/// threads at once. Dropping a handle leaves the scene on the server.
///
/// Errors: as for Client, and NOT_FOUND once the scene, or the thing that a handle names, is gone. A call that fails
/// changed nothing. Members that change something return the scene's new revision.
class Scene {
 public:
  /// scenes/{scene}
  const std::string& name() const;

  absl::StatusOr<MaterialHandle> add_material(const Material& material) const;
  /// The material as the server took it: the coefficients in force, and warnings of what is doubtful about them.
  absl::StatusOr<MaterialInfo> material(const MaterialHandle& handle) const;
  absl::StatusOr<uint64_t> update_material(const MaterialHandle& handle, const Material& material) const;
  /// Errors: FAILED_PRECONDITION while a mesh uses it.
  absl::StatusOr<uint64_t> remove_material(const MaterialHandle& handle) const;

  /// Uploads a picture for surfaces. Errors: INVALID_ARGUMENT a size out of range, or other pixels than it says;
  /// RESOURCE_EXHAUSTED past a limit.
  absl::StatusOr<TextureHandle> add_texture(const TextureData& texture) const;
  /// Errors: FAILED_PRECONDITION while a material uses it.
  absl::StatusOr<uint64_t> remove_texture(const TextureHandle& handle) const;

  absl::StatusOr<LightHandle> add_light(const Light& light) const;
  absl::StatusOr<uint64_t> update_light(const LightHandle& handle, const Light& light) const;
  absl::StatusOr<uint64_t> remove_light(const LightHandle& handle) const;

  /// Uploads light from all around, in place of what the scene had. Lamps in it are told apart by the server and cast
  /// shadows. Errors: INVALID_ARGUMENT a size, pixel or option out of range; RESOURCE_EXHAUSTED past a limit.
  absl::StatusOr<uint64_t> set_environment(const EnvironmentMap& map, const EnvironmentOptions& options = {}) const;
  /// Turns it, or changes its strength. NOT_FOUND where the scene has none.
  absl::StatusOr<uint64_t> update_environment(const EnvironmentOptions& options) const;
  absl::StatusOr<uint64_t> remove_environment() const;

  /// Uploads a mesh, its scene_from_mesh, texture coordinates and colours included, in chunks of at most 1 MiB.
  ///
  /// Errors: INVALID_ARGUMENT no triangle, an index past the last vertex, a position that is not finite, normals that
  /// are neither none nor one per position; RESOURCE_EXHAUSTED past a limit of ServerInfo.
  absl::StatusOr<MeshHandle> add_mesh(const MeshData& mesh, const MeshOptions& options) const;

  /// Changes what `update` gives; it must give at least one.
  absl::StatusOr<uint64_t> update_mesh(const MeshHandle& handle, const MeshUpdate& update) const;

  /// Replaces every position of a mesh at once: as many as it has vertices, in mesh units. `normals` is empty, and the
  /// server computes them from now on, or one per position.
  absl::StatusOr<uint64_t> update_positions(const MeshHandle& handle, std::span<const Vec3> positions,
                                            std::span<const Vec3> normals = {}) const;
  absl::StatusOr<uint64_t> remove_mesh(const MeshHandle& handle) const;

  /// The scene and all that is in it.
  absl::StatusOr<SceneDescription> describe() const;

  /// One frame of the newest revision: it shows every change that returned before this call.
  ///
  /// Errors: FAILED_PRECONDITION no mesh; INVALID_ARGUMENT camera, size or settings out of range; RESOURCE_EXHAUSTED
  /// the server's render queue is full; DEADLINE_EXCEEDED also past ServerInfo::max_reference_seconds.
  absl::StatusOr<RenderedFrame> render(const RenderOptions& options = {}) const;

  /// The same, and `progress` is told the share of the work done, 0..1, at most about ten times a second and at last 1,
  /// on the calling thread. Only Technique::kReference knows what lies between. It grows, unless the connection was
  /// lost and the frame begun anew.
  absl::StatusOr<RenderedFrame> render(const RenderOptions& options, const std::function<void(double)>& progress) const;

  /// What lies under a pixel of a frame of that camera and size; nothing where no surface does. `x_px`, `y_px` from the
  /// frame's upper left corner: 0.5, 0.5 is the first pixel's centre.
  ///
  /// Errors: INVALID_ARGUMENT a camera or size out of range, or a pixel beyond the frame; RESOURCE_EXHAUSTED too many
  /// such calls wait.
  absl::StatusOr<std::optional<PickedPoint>> pick(const Camera& camera, const Size& size, float x_px, float y_px) const;

  /// Frames as the scene changes.
  FrameStream stream(const StreamOptions& options) const;
  /// A way for live changes. Several may change one scene; each keeps the order of its own.
  Deformer deform(const DeformerOptions& options = {}) const;

  /// Deletes the scene and all that is in it. Runs even once ClientOptions::stop was requested.
  absl::Status remove() const;

 private:
  friend class Client;
  Scene(std::shared_ptr<internal::Connection> connection, std::string name);

  std::shared_ptr<internal::Connection> connection_;
  std::string name_;
};

}  // namespace diaphane

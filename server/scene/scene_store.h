// All scenes of the process.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/container/flat_hash_map.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "scene/limits.h"
#include "scene/memory_budget.h"
#include "scene/names.h"
#include "scene/snapshot.h"

namespace diaphane::scene {

using SnapshotPtr = std::shared_ptr<const SceneSnapshot>;
using EnvironmentPtr = std::shared_ptr<const Environment>;

/// What is given replaces what was there.
struct ScenePatch {
  std::optional<std::string> display_name;
  std::optional<double> millimetres_per_unit;
};

struct NewMaterial {
  optics::MaterialForm form;
  optics::Profile profile = optics::Profile::kDipole;
  std::optional<optics::Coat> coat{};
  SurfaceTextures textures{};
};

/// What is given replaces what was there.
struct MaterialPatch {
  std::optional<optics::MaterialForm> form;
  std::optional<optics::Profile> profile;
  std::optional<std::optional<optics::Coat>> coat;  ///< an empty one takes the coat off
  std::optional<SurfaceTextures> textures{};
};

/// A whole light, or parts of one that is a point light.
struct LightPatch {
  std::optional<glm::vec3> position;
  std::optional<glm::vec3> intensity_w_sr;
  std::optional<LightKind> kind;
};

struct EnvironmentPatch {
  std::optional<float> rotation_deg;
  std::optional<float> intensity;
  std::optional<bool> occlusion;
};

struct MeshPatch {
  std::optional<std::string> material;
  std::optional<glm::mat4> scene_from_mesh;
};

/// New positions of some vertices, or of all.
struct PositionsPatch {
  std::vector<uint32_t> indices;     ///< empty: all, in order
  std::vector<glm::vec3> positions;  ///< mesh units, one for each; what check_finite() lets by
  bool displacements = false;        ///< from the uploaded positions
};

/// The uploaded shape, and of each of the mesh's morph targets so much.
struct WeightsPatch {
  std::vector<float> weights;
};

/// The uploaded shape, so far on its way to its bounding sphere: geometry::morphed_to_sphere().
struct SpherePatch {
  float amount = 0;
};

/// One change of an edit: which resource, and what it becomes.
struct SceneChange {
  std::string name;
  std::variant<PositionsPatch, WeightsPatch, SpherePatch, MeshPatch, MaterialPatch, LightPatch, EnvironmentPatch> patch;
};

/// How big a mesh will be.
struct MeshCounts {
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  bool has_normals = false;
  bool has_texture_coordinates = false;
  bool has_colors = false;
  uint32_t morph_target_count = 0;
};

struct NewMesh {
  std::string material;
  glm::mat4 scene_from_mesh{1};
  std::shared_ptr<const geometry::MeshTopology> topology;
  std::shared_ptr<const geometry::MeshShape> shape;
  std::shared_ptr<const geometry::SurfaceAttributes> attributes{};  ///< null: none
  std::shared_ptr<const geometry::MorphTargets> morph_targets{};    ///< null: none
};

/// A resource after a mutation, and the scene's revision that the mutation made.
template <typename T>
struct Changed {
  T value;
  uint64_t scene_revision = 0;
};

struct ScenePage {
  std::vector<SnapshotPtr> scenes;  ///< oldest first
  std::string next_page_token;      ///< empty: this was the last page
};

/// Thread-safe registry of scenes. A mutation replaces a scene's snapshot by a changed copy, whole or not at all; who
/// holds the old one keeps it. Every mutation raises the scene's revision by one; a new scene is at revision 1.
///
/// Values come in checked, except for names. Errors of all: INVALID_ARGUMENT for a name of the wrong form, NOT_FOUND
/// for a name of nothing, RESOURCE_EXHAUSTED at a limit; each names its field.
class SceneStore {
 public:
  explicit SceneStore(const SceneLimits& limits) : limits_(limits), budget_(limits.max_mesh_bytes) {}

  absl::StatusOr<SnapshotPtr> create_scene(const ScenePatch& values) ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<SnapshotPtr> scene(const Reference& scene) const ABSL_LOCKS_EXCLUDED(mutex_);
  /// `page_size` at least 1. `token` is a page's next_page_token, or empty for the first page.
  absl::StatusOr<ScenePage> scenes(size_t page_size, const Reference& token) const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<SnapshotPtr> update_scene(const Reference& scene, const ScenePatch& patch);
  absl::Status delete_scene(const Reference& scene) ABSL_LOCKS_EXCLUDED(mutex_);

  /// Textures that a material names must be of its scene: else INVALID_ARGUMENT, or NOT_FOUND.
  absl::StatusOr<Changed<Material>> create_material(const Reference& parent, const NewMaterial& material);
  absl::StatusOr<Material> material(const Reference& material) const;
  absl::StatusOr<Changed<Material>> update_material(const Reference& material, const MaterialPatch& patch);
  /// Returns the new scene revision. FAILED_PRECONDITION while a mesh uses it.
  absl::StatusOr<uint64_t> delete_material(const Reference& material);

  absl::StatusOr<Changed<Light>> create_light(const Reference& parent, const LightKind& light);
  absl::StatusOr<Light> light(const Reference& light) const;
  absl::StatusOr<Changed<Light>> update_light(const Reference& light, const LightPatch& patch);
  absl::StatusOr<uint64_t> delete_light(const Reference& light);

  /// Reserves what a mesh of `counts` takes while its payload is read and indexed, and checks that it may be created.
  /// RESOURCE_EXHAUSTED past max_vertices_per_mesh, max_triangles_per_mesh, max_meshes_per_scene or max_mesh_bytes;
  /// `mesh.material` as create_mesh.
  absl::StatusOr<Reservation> reserve_mesh(const Reference& parent, const Reference& material,
                                           const MeshCounts& counts);
  /// `reservation` is from reserve_mesh for these counts; what is not needed any more is given back.
  /// INVALID_ARGUMENT when the material is of another scene, NOT_FOUND when the scene has none of that name.
  absl::StatusOr<Changed<Mesh>> create_mesh(const Reference& parent, NewMesh mesh, Reservation reservation);
  absl::StatusOr<Mesh> mesh(const Reference& mesh) const;
  absl::StatusOr<Changed<Mesh>> update_mesh(const Reference& mesh, const MeshPatch& patch);
  absl::StatusOr<uint64_t> delete_mesh(const Reference& mesh);

  /// Reserves what new positions of `mesh` take. INVALID_ARGUMENT unless `vertex_count` is the mesh's.
  absl::StatusOr<Reservation> reserve_positions(const Reference& mesh, uint32_t vertex_count, bool has_normals);
  /// Replaces every position. `reservation` is from reserve_positions for this mesh.
  absl::StatusOr<Changed<Mesh>> replace_positions(const Reference& mesh,
                                                  std::shared_ptr<const geometry::MeshShape> shape,
                                                  Reservation reservation);

  /// Reserves what a map of that size takes while it is read and analysed.
  absl::StatusOr<Reservation> reserve_environment(const Reference& parent, uint32_t width_px, uint32_t height_px);
  /// In place of the one that the scene had. `reservation` is from reserve_environment for this size.
  absl::StatusOr<Changed<EnvironmentPtr>> set_environment(const Reference& parent, Environment environment,
                                                          Reservation reservation);
  absl::StatusOr<EnvironmentPtr> environment(const Reference& environment) const;
  absl::StatusOr<Changed<EnvironmentPtr>> update_environment(const Reference& environment,
                                                             const EnvironmentPatch& patch);
  absl::StatusOr<uint64_t> delete_environment(const Reference& environment);

  /// Reserves what a texture of that size takes, its copy on the GPU included. RESOURCE_EXHAUSTED past
  /// max_textures_per_scene or max_mesh_bytes.
  absl::StatusOr<Reservation> reserve_texture(const Reference& parent, uint32_t width_px, uint32_t height_px);
  /// `reservation` is from reserve_texture for this size.
  absl::StatusOr<Changed<Texture>> create_texture(const Reference& parent, Texture texture, Reservation reservation);
  absl::StatusOr<Texture> texture(const Reference& texture) const;
  /// FAILED_PRECONDITION while a material uses it.
  absl::StatusOr<uint64_t> delete_texture(const Reference& texture);

  /// Takes memory for what is on its way to be applied, given back by the caller.
  absl::StatusOr<Reservation> reserve(uint64_t bytes) { return budget_.reserve(bytes); }
  /// Applies all changes as one revision, or none: the error of the first that cannot be, its field with "changes[i]."
  /// before it; INVALID_ARGUMENT where results are not within ±1e18. What a later change of an edit replaces whole is
  /// not worked out. Returns the new revision.
  absl::StatusOr<uint64_t> apply(const Reference& scene, std::vector<SceneChange> changes);

  /// Told of a scene's every revision, in order, and at last nothing, when the scene is deleted. Called with the
  /// store's lock held: it must be quick, and must not call the store.
  using Watcher = std::function<void(const SnapshotPtr&)>;
  /// Tells `watcher` the newest revision at once, and goes on for as long as what it returns is kept.
  absl::StatusOr<std::shared_ptr<const Watcher>> watch(const Reference& scene, Watcher watcher)
      ABSL_LOCKS_EXCLUDED(mutex_);

  const SceneLimits& limits() const { return limits_; }
  /// Of all meshes, environments, textures and uploads in flight.
  uint64_t mesh_bytes() const { return budget_.used_bytes(); }

 private:
  using Change = absl::FunctionRef<absl::Status(SceneSnapshot& draft)>;

  /// Applies `change` to a copy of the scene at the next revision, and puts the copy in the scene's place if it is OK.
  absl::StatusOr<SnapshotPtr> mutate(const Reference& scene, Change change) ABSL_LOCKS_EXCLUDED(mutex_);
  void tell_watchers(const std::string& scene, const SnapshotPtr& snapshot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  /// The same for the scene of a child.
  absl::StatusOr<SnapshotPtr> mutate_parent(const Reference& child, Collection collection, Change change);
  template <typename Child, typename Patch>
  absl::StatusOr<Changed<Child>> update_child(const Reference& child, Collection collection, const Patch& patch);
  /// The scene of a child, which itself need not exist.
  absl::StatusOr<SnapshotPtr> parent_of(const Reference& child, Collection collection) const;

  const SceneLimits limits_;
  MemoryBudget budget_;
  mutable absl::Mutex mutex_;
  // By order of creation, so that a page starts where the one before it ended whatever came and went between.
  std::map<uint64_t, SnapshotPtr> scenes_ ABSL_GUARDED_BY(mutex_);
  absl::flat_hash_map<std::string, uint64_t> order_of_name_ ABSL_GUARDED_BY(mutex_);
  uint64_t next_order_ ABSL_GUARDED_BY(mutex_) = 1;
  absl::flat_hash_map<std::string, std::vector<std::weak_ptr<const Watcher>>> watchers_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace diaphane::scene

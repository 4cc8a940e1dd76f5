// What an edit makes of the shapes of a scene's meshes, worked out beside the store's lock. Internal to the room.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "scene/memory_budget.h"
#include "scene/scene_store.h"
#include "scene/snapshot.h"

namespace diaphane::scene {

/// Whether a change makes a new shape.
bool reshapes(const SceneChange& change);

/// The new shapes of an edit, one a mesh however many changes it has.
class Reshaping {
 public:
  /// Both outlive it. Positions of all vertices are moved out of their changes.
  Reshaping(std::span<SceneChange> changes, MemoryBudget& budget) : changes_(changes), budget_(budget) {}

  /// Works out what is not yet, or not from the meshes as they are in `scene`. RESOURCE_EXHAUSTED alone: other errors
  /// are told by status_of().
  absl::Status follow(const SceneSnapshot& scene);

  /// Of change `i`: OK but for the first that cannot be.
  absl::Status status_of(size_t i) const { return i == failed_ ? status_ : absl::OkStatus(); }

  /// Gives the meshes of `draft` their shapes, all or none: false where one has gone, or has moved since follow() and
  /// only some of its vertices were given.
  bool put_into(SceneSnapshot& draft) const;

 private:
  struct Reshaped {
    std::shared_ptr<const Mesh> mesh;  // as it was
    std::vector<size_t> changes;       // the last that makes a whole shape, if any, and those after it
    bool is_whole = false;             // nothing of the old shape is left
    std::shared_ptr<const geometry::MeshShape> shape{};  // null: not worked out yet
  };

  /// Notes what a change needs of its mesh, and checks what needs no new shape.
  absl::Status plan_one(const SceneSnapshot& scene, size_t i);
  absl::Status work_out(Reshaped& reshaped);
  /// At an error `*at` is the change that it is of.
  absl::StatusOr<geometry::MeshShape> make(const Reshaped& reshaped, size_t* at) const;
  void fail(size_t i, absl::Status status);

  const std::span<SceneChange> changes_;
  MemoryBudget& budget_;
  bool is_planned_ = false;
  std::vector<Reshaped> meshes_;
  size_t failed_ = SIZE_MAX;
  absl::Status status_;
};

}  // namespace diaphane::scene

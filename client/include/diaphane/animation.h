// Bodies of glTF files as they move.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/readers.h"

namespace diaphane {

struct AnimationInfo {
  std::string name;       ///< "animation N" where the file gives none
  double duration_s = 0;  ///< of its last key
};

/// Where one mesh is at a moment, in scene units; normals as MeshData has them.
struct MeshPose {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
};

/// A glTF 2.0 file with its animations: nodes, skins and morph weights, evaluated here, so that a server needs
/// positions alone. Thread-safe: pose() may be called by several threads at once.
class AnimatedFile {
 public:
  /// Reads a file as read_mesh_file() does, but with every mesh in scene units (its scene_from_mesh is the identity)
  /// and turned outward where its node mirrors it; those that a scale of 0 flattens at rest are there.
  ///
  /// Errors: as read_mesh_file's, and kInvalidArgument for another format, or an animation that is malformed: keys not
  /// in order, not finite or too few, references to nothing. What it moves that is not known here is left out with a
  /// warning.
  static absl::StatusOr<AnimatedFile> read(const std::filesystem::path& path, const ReadLimits& limits = {});

  AnimatedFile(AnimatedFile&&) noexcept;
  AnimatedFile& operator=(AnimatedFile&&) noexcept;
  ~AnimatedFile();

  /// Without animation.
  const LoadedFile& rest() const;
  /// In the file's order; may be none.
  std::span<const AnimationInfo> animations() const;

  /// All meshes of rest(), in its order, at `seconds` of an animation; before its first key and after its last as at
  /// those. glTF 2.0 appendix C: STEP, LINEAR (rotations along the shorter great arc) and CUBICSPLINE.
  ///
  /// Errors: kOutOfRange no such animation; kInvalidArgument the pose is not finite, or has a rotation of length 0.
  absl::StatusOr<std::vector<MeshPose>> pose(size_t animation, double seconds) const;

 private:
  class Impl;
  explicit AnimatedFile(std::unique_ptr<const Impl> impl);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace diaphane

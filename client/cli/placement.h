// How large the meshes are, and where they are seen from.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "diaphane/framing.h"
#include "diaphane/mesh_data.h"
#include "diaphane/values.h"
#include "render_arguments.h"

namespace diaphane::cli {

/// What files say of their unit.
struct FileUnits {
  std::optional<double> stated;  ///< by a scene file
  size_t meshes = 0;
  size_t meshes_with_unit = 0;
  double millimetres_per_unit = 0;
  bool agree = true;

  void add(const std::optional<double>& unit);
  /// The scene file's word, else the mesh files' where all of them say the same.
  std::optional<double> known() const;
};

struct Unit {
  double millimetres_per_unit = 1;
  std::string note;  ///< when it was a guess
};

/// The command line's word, else the files', else such that the height along `up` is 50 mm (the largest side where the
/// meshes have no height). Errors: kExitUsage for a height asked of meshes that have none.
absl::StatusOr<Unit> choose_unit(const RenderArguments& arguments, const FileUnits& units,
                                 std::span<const MeshData> meshes, const Vec3& up);

/// The scene file's camera, else one framed on `bounds`; then what the command line says of it. A target without an eye
/// moves the framed camera along.
Camera choose_camera(const RenderArguments& arguments, const std::optional<Camera>& from_file, const Bounds& bounds,
                     const Size& size);

}  // namespace diaphane::cli

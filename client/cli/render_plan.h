// Everything that a render needs from this machine, read and checked before any server is asked.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/environment.h"
#include "diaphane/framing.h"
#include "diaphane/mesh_data.h"
#include "diaphane/readers.h"
#include "diaphane/render_options.h"
#include "diaphane/texture.h"
#include "diaphane/values.h"
#include "render_arguments.h"

namespace diaphane::cli {

/// A material whose pictures are still to be uploaded.
struct PlannedMaterial {
  Material material;
  std::optional<size_t> albedo, normal, roughness;  ///< into RenderPlan::textures
};

struct RenderPlan {
  std::string display_name;
  std::vector<MeshData> meshes;
  std::vector<size_t> material_of_mesh;  ///< into `materials`, one per mesh
  std::vector<PlannedMaterial> materials;
  std::vector<TextureData> textures;
  std::optional<float> refractive_index;  ///< in place of that of the first material, a preset
  std::vector<Light> lights;              ///< at least one, unless there is an environment
  std::optional<EnvironmentMap> environment;
  EnvironmentOptions environment_options;
  double millimetres_per_unit = 1;
  RenderOptions options;
  std::vector<std::string> notes;  ///< one line each, for stderr
};

/// What a plan is made with besides the command line.
struct PlanSource {
  std::optional<LoadedFile> file;  ///< what the one mesh file holds; not given: it is read
  /// Called once the meshes are there, which it may change: what camera and light are to be chosen for. Not given: the
  /// meshes' bounds.
  std::function<absl::StatusOr<Bounds>(RenderPlan&)> bounds;
};

/// Reads the meshes, or the scene file and its meshes, and settles what was left open: size, camera, lights.
///
/// Errors: exit code kExitFile for files, kExitUsage for a --height-mm of meshes that have no height.
absl::StatusOr<RenderPlan> plan_render(const RenderArguments& arguments, PlanSource source = {});

}  // namespace diaphane::cli

#include "render_plan.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "diaphane/framing.h"
#include "diaphane/readers.h"
#include "diaphane/scene_file.h"
#include "fmt/format.h"
#include "placement.h"
#include "status.h"

namespace diaphane::cli {
namespace {

namespace fs = std::filesystem;
using Matrix = std::array<float, 16>;

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t i = 0; i < 4; ++i) product[4 * column + row] += a[4 * i + row] * b[4 * column + i];
    }
  }
  return product;
}

constexpr float kDefaultRoughness = 0.1f;

Material material_of(const RenderArguments& arguments) {
  Material material;
  if (arguments.profile) material.profile = *arguments.profile;
  if (arguments.coat) material.coat = Coat{arguments.roughness.value_or(kDefaultRoughness)};
  // Of each pair, the one needs the other on the command line.
  if (arguments.absorption_mm && arguments.reduced_scattering_mm) {
    Coefficients coefficients{*arguments.absorption_mm, *arguments.reduced_scattering_mm};
    if (arguments.refractive_index) coefficients.refractive_index = *arguments.refractive_index;
    material.model = coefficients;
  } else if (arguments.diffuse_color && arguments.mean_free_path_mm) {
    DiffuseColor color{*arguments.diffuse_color, *arguments.mean_free_path_mm};
    if (arguments.refractive_index) color.refractive_index = *arguments.refractive_index;
    material.model = color;
  } else {
    material.model = arguments.preset.value_or(kDefaultPreset);
  }
  return material;
}

/// What the command line says of a file's own material.
void take_material_options(const RenderArguments& arguments, Material* material) {
  if (arguments.profile) material->profile = *arguments.profile;
  if (arguments.coat) material->coat = Coat{arguments.roughness.value_or(kDefaultRoughness)};
  if (!arguments.refractive_index) return;
  if (auto* color = std::get_if<DiffuseColor>(&material->model)) color->refractive_index = *arguments.refractive_index;
  if (auto* volume = std::get_if<Volume>(&material->model)) volume->refractive_index = *arguments.refractive_index;
}

/// Adds meshes to a plan, with the materials and pictures that their files bring along.
class MeshPlanner {
 public:
  MeshPlanner(RenderPlan* plan, FileUnits* units) : plan_(plan), units_(units) {}

  /// `material`: of all meshes; none: the file's own, or else `otherwise`. `arguments`, where given, change those.
  absl::Status read(const fs::path& path, const Matrix& scene_from_file, std::optional<size_t> material,
                    size_t otherwise, const RenderArguments* arguments) {
    absl::StatusOr<LoadedFile> file = read_mesh_file(path);
    if (!file.ok()) return with_exit_code(file.status(), kExitFile);
    take(path, *std::move(file), scene_from_file, material, otherwise, arguments);
    return absl::OkStatus();
  }

  /// The same of a file that was read.
  void take(const fs::path& path, LoadedFile file, const Matrix& scene_from_file, std::optional<size_t> material,
            size_t otherwise, const RenderArguments* arguments) {
    units_->add(file.millimetres_per_unit);
    for (const std::string& warning : file.warnings) {
      plan_->notes.push_back(fmt::format("{}: {}", path.string(), warning));
    }
    const size_t first = plan_->materials.size();
    if (!material) take_materials(file, arguments);
    for (MeshData& mesh : file.meshes) {
      mesh.scene_from_mesh = multiply(scene_from_file, mesh.scene_from_mesh);
      const size_t own = mesh.material ? first + *mesh.material : otherwise;
      plan_->material_of_mesh.push_back(material.value_or(own));
      plan_->meshes.push_back(std::move(mesh));
    }
  }

 private:
  void take_materials(LoadedFile& file, const RenderArguments* arguments) {
    const size_t first = plan_->textures.size();
    const auto moved = [first](const std::optional<size_t>& texture) {
      return texture ? std::optional(first + *texture) : std::nullopt;
    };
    for (FileMaterial& from : file.materials) {
      PlannedMaterial& to = plan_->materials.emplace_back();
      to = {std::move(from.material), moved(from.albedo), moved(from.normal), moved(from.roughness)};
      to.material.textures.normal_scale = from.normal_scale;
      if (arguments != nullptr) take_material_options(*arguments, &to.material);
    }
    std::move(file.textures.begin(), file.textures.end(), std::back_inserter(plan_->textures));
  }

  RenderPlan* plan_;
  FileUnits* units_;
};

absl::Status take_arguments(const RenderArguments& arguments, std::optional<LoadedFile> file, RenderPlan* plan,
                            FileUnits* units) {
  plan->materials.push_back({material_of(arguments)});
  if (!arguments.absorption_mm && !arguments.diffuse_color) plan->refractive_index = arguments.refractive_index;
  plan->lights = arguments.lights;
  const bool chosen = arguments.preset || arguments.absorption_mm || arguments.diffuse_color;
  MeshPlanner planner(plan, units);
  const std::optional<size_t> material = chosen ? std::optional<size_t>(0) : std::nullopt;
  if (file) {
    planner.take(arguments.meshes.front(), *std::move(file), MeshData().scene_from_mesh, material, 0, &arguments);
    return absl::OkStatus();
  }
  for (const std::string& mesh : arguments.meshes) {
    absl::Status status = planner.read(mesh, MeshData().scene_from_mesh, material, 0, &arguments);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status take_picture(const fs::path& path, bool srgb, RenderPlan* plan, std::optional<size_t>* index) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<TextureData> texture = read_texture_file(path, srgb);
  if (!texture.ok()) return with_exit_code(texture.status(), kExitFile);
  *index = plan->textures.size();
  plan->textures.push_back(*std::move(texture));
  return absl::OkStatus();
}

absl::Status take_scene_file(SceneFile scene, RenderPlan* plan, FileUnits* units) {
  plan->display_name = scene.display_name;
  units->stated = scene.millimetres_per_unit;
  for (SceneFile::NamedMaterial& named : scene.materials) {
    PlannedMaterial material{std::move(named.material)};
    absl::Status status = take_picture(named.albedo_file, true, plan, &material.albedo);
    if (status.ok()) status = take_picture(named.normal_file, false, plan, &material.normal);
    if (status.ok()) status = take_picture(named.roughness_file, false, plan, &material.roughness);
    if (!status.ok()) return status;
    plan->materials.push_back(std::move(material));
  }
  plan->lights = std::move(scene.lights);
  plan->options.settings = scene.settings;
  if (scene.size) plan->options.size = *scene.size;
  const size_t default_material = plan->materials.size();
  plan->materials.emplace_back();
  MeshPlanner planner(plan, units);
  for (const SceneFile::MeshFile& mesh : scene.meshes) {
    absl::Status status = planner.read(mesh.path, mesh.scene_from_mesh, mesh.material, default_material, nullptr);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Options given on the command line win over the scene file's.
void take_settings(const RenderArguments& arguments, RenderOptions* options) {
  options->format = arguments.format;
  RenderSettings& settings = options->settings;
  if (arguments.channels) options->channels = *arguments.channels;
  if (arguments.size) options->size = *arguments.size;
  if (arguments.technique) settings.technique = *arguments.technique;
  if (arguments.quality) settings.quality = *arguments.quality;
  if (arguments.shadows) settings.shadows = *arguments.shadows;
  if (arguments.slab_correction) settings.slab_correction = true;
  if (arguments.terms) settings.paper.terms = *arguments.terms;
  if (arguments.kernel_taps) settings.paper.kernel_taps = *arguments.kernel_taps;
  if (arguments.face_size_px) settings.paper.face_size_px = *arguments.face_size_px;
  if (arguments.global_gain) settings.paper.global_gain = *arguments.global_gain;
  if (arguments.exposure) settings.exposure_ev = arguments.exposure->ev;
  if (arguments.exposure) settings.auto_exposure = arguments.exposure->found;
  if (arguments.tone_mapping) settings.tone_mapping = *arguments.tone_mapping;
  if (arguments.samples) settings.samples = *arguments.samples;
  if (arguments.background) settings.background = arguments.background->color;
  if (arguments.background) settings.environment_background = arguments.background->environment;
}

}  // namespace

absl::StatusOr<RenderPlan> plan_render(const RenderArguments& arguments, PlanSource source) {
  RenderPlan plan;
  FileUnits units;
  std::optional<Camera> camera;
  if (arguments.scene_file.empty()) {
    absl::Status status = take_arguments(arguments, std::move(source.file), &plan, &units);
    if (!status.ok()) return status;
  } else {
    absl::StatusOr<SceneFile> scene = read_scene_file(arguments.scene_file);
    if (!scene.ok()) return with_exit_code(scene.status(), kExitFile);
    camera = scene->camera;
    if (absl::Status status = take_scene_file(*std::move(scene), &plan, &units); !status.ok()) return status;
  }
  take_settings(arguments, &plan.options);

  const absl::StatusOr<Bounds> bounds = source.bounds ? source.bounds(plan) : bounds_of(plan.meshes);
  if (!bounds.ok()) return source.bounds ? bounds.status() : with_exit_code(bounds.status(), kExitFile);
  plan.options.camera = choose_camera(arguments, camera, *bounds, plan.options.size);
  absl::StatusOr<Unit> unit = choose_unit(arguments, units, plan.meshes, plan.options.camera.up);
  if (!unit.ok()) return unit.status();
  plan.millimetres_per_unit = unit->millimetres_per_unit;
  if (!unit->note.empty()) plan.notes.push_back(std::move(unit->note));
  if (!arguments.environment_file.empty()) {
    absl::StatusOr<EnvironmentMap> map = read_environment_file(arguments.environment_file);
    if (!map.ok()) return with_exit_code(map.status(), kExitFile);
    plan.environment = *std::move(map);
    if (arguments.environment_rotation_deg) plan.environment_options.rotation_deg = *arguments.environment_rotation_deg;
    plan.environment_options.occlusion = arguments.environment_occlusion;
    if (arguments.environment_intensity) plan.environment_options.intensity = *arguments.environment_intensity;
  }
  if (plan.lights.empty() && !plan.environment)
    plan.lights = {key_light(*bounds, plan.options.camera, plan.millimetres_per_unit)};
  return plan;
}

}  // namespace diaphane::cli

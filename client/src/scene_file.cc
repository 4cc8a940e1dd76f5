#include "diaphane/scene_file.h"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <tuple>

#include "convert.h"
#include "fmt/format.h"
#include "google/protobuf/util/json_util.h"
#include "scene_file.pb.h"
#include "strict_json.h"

namespace diaphane {
namespace {

namespace fs = std::filesystem;
using internal::SceneFileForm;

constexpr size_t kMaxBytes = size_t{16} << 20;

absl::Status error(absl::StatusCode code, const fs::path& path, std::string_view what) {
  std::string message = fmt::format("{}: {}", path.string(), what);
  std::replace(message.begin(), message.end(), '\n', ' ');
  return absl::Status(code, message);
}

absl::Status invalid(const fs::path& path, std::string_view what) {
  return error(absl::StatusCode::kInvalidArgument, path, what);
}

absl::StatusOr<std::string> read_text(const fs::path& path) {
  std::error_code code;
  const fs::file_status file = fs::status(path, code);
  if (file.type() == fs::file_type::not_found) return error(absl::StatusCode::kNotFound, path, "no such file");
  if (code) return error(absl::StatusCode::kPermissionDenied, path, code.message());
  if (!fs::is_regular_file(file)) return invalid(path, "not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return error(absl::StatusCode::kPermissionDenied, path, "cannot be opened");
  std::string text(kMaxBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(stream.gcount()));
  if (text.size() > kMaxBytes) return error(absl::StatusCode::kResourceExhausted, path, "longer than 16 MiB");
  return text;
}

absl::StatusOr<SceneFileForm> parse(const fs::path& path, const std::string& text) {
  if (absl::Status status = internal::check_json(text); !status.ok()) {
    return invalid(path, std::string(status.message()));
  }
  SceneFileForm form;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &form);
  if (!status.ok()) return invalid(path, std::string(status.message()));
  return form;
}

// Names of the fields that a scene file gave although only the server sets them.
std::string first_output_field(const SceneFileForm& form) {
  const v1::Scene& scene = form.scene();
  if (!scene.name().empty()) return "scene.name";
  if (scene.revision() != 0) return "scene.revision";
  if (scene.mesh_count() != 0) return "scene.mesh_count";
  if (scene.material_count() != 0) return "scene.material_count";
  if (scene.light_count() != 0) return "scene.light_count";
  for (int i = 0; i < form.materials_size(); ++i) {
    if (form.materials(i).has_resolved()) return fmt::format("materials[{}].resolved", i);
    if (form.materials(i).warnings_size() != 0) return fmt::format("materials[{}].warnings", i);
  }
  for (int i = 0; i < form.lights_size(); ++i) {
    if (!form.lights(i).name().empty()) return fmt::format("lights[{}].name", i);
  }
  return {};
}

// Symbolic links count for what they point to.
bool leaves_folder(const fs::path& folder, const fs::path& file) {
  if (file.is_absolute()) return true;
  std::error_code code;
  const fs::path root = fs::weakly_canonical(folder, code);
  const fs::path target = fs::weakly_canonical(folder / file, code);
  return code || std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first != root.end();
}

absl::Status check_path(const fs::path& path, const fs::path& folder, std::string_view field, const std::string& file) {
  if (file.find('\0') == std::string::npos && !leaves_folder(folder, file)) return absl::OkStatus();
  return invalid(path, fmt::format("{}: must be a relative path that stays in this folder, got '{}'", field, file));
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

absl::Status take_textures(const fs::path& path, int i, const v1::SurfaceTextures& textures,
                           SceneFile::NamedMaterial* material) {
  const fs::path folder = folder_of(path);
  for (const auto& [name, file, to] : {std::tuple("albedo", &textures.albedo(), &material->albedo_file),
                                       std::tuple("normal", &textures.normal(), &material->normal_file),
                                       std::tuple("roughness", &textures.roughness(), &material->roughness_file)}) {
    if (file->empty()) continue;
    absl::Status stays = check_path(path, folder, fmt::format("materials[{}].textures.{}", i, name), *file);
    if (!stays.ok()) return stays;
    *to = folder / *file;
  }
  material->material.textures = {.normal_scale = material->material.textures.normal_scale};
  return absl::OkStatus();
}

absl::Status convert_materials(const fs::path& path, const SceneFileForm& form, SceneFile* scene) {
  for (int i = 0; i < form.materials_size(); ++i) {
    const v1::Material& material = form.materials(i);
    const auto same = [&](const auto& other) { return other.name == material.name(); };
    if (material.name().empty()) return invalid(path, fmt::format("materials[{}].name: must be given", i));
    if (std::any_of(scene->materials.begin(), scene->materials.end(), same)) {
      return invalid(path, fmt::format("materials[{}].name: '{}' is given twice", i, material.name()));
    }
    if (material.model_case() == v1::Material::MODEL_NOT_SET) {
      return invalid(path, fmt::format("materials[{}]: must have preset, coefficients, diffuse_color or volume", i));
    }
    SceneFile::NamedMaterial named{material.name(), internal::from_proto(material), {}, {}, {}};
    absl::Status taken = take_textures(path, i, material.textures(), &named);
    if (!taken.ok()) return taken;
    scene->materials.push_back(std::move(named));
  }
  return absl::OkStatus();
}

absl::Status convert_lights(const fs::path& path, const SceneFileForm& form, SceneFile* scene) {
  for (int i = 0; i < form.lights_size(); ++i) {
    if (form.lights(i).kind_case() == v1::Light::KIND_NOT_SET) {
      return invalid(path, fmt::format("lights[{}]: must be point, directional or spot", i));
    }
    scene->lights.push_back(internal::from_proto(form.lights(i)));
  }
  return absl::OkStatus();
}

absl::Status convert_meshes(const fs::path& path, const SceneFileForm& form, SceneFile* scene) {
  if (form.meshes_size() == 0) return invalid(path, "meshes: must have at least one");
  const fs::path folder = folder_of(path);
  for (int i = 0; i < form.meshes_size(); ++i) {
    const internal::MeshFileForm& mesh = form.meshes(i);
    SceneFile::MeshFile file{.path = folder / mesh.file()};
    if (mesh.file().empty()) return invalid(path, fmt::format("meshes[{}].file: must be given", i));
    absl::Status stays = check_path(path, folder, fmt::format("meshes[{}].file", i), mesh.file());
    if (!stays.ok()) return stays;
    if (!mesh.material().empty()) {
      const auto found = std::find_if(scene->materials.begin(), scene->materials.end(),
                                      [&](const auto& material) { return material.name == mesh.material(); });
      if (found == scene->materials.end()) {
        return invalid(path,
                       fmt::format("meshes[{}].material: no material of this file is called '{}'", i, mesh.material()));
      }
      file.material = static_cast<size_t>(found - scene->materials.begin());
    }
    const int elements = mesh.scene_from_mesh_size();
    if (elements != 0 && elements != static_cast<int>(file.scene_from_mesh.size())) {
      return invalid(path, fmt::format("meshes[{}].scene_from_mesh: must be 16 numbers, got {}", i, elements));
    }
    std::copy(mesh.scene_from_mesh().begin(), mesh.scene_from_mesh().end(), file.scene_from_mesh.begin());
    scene->meshes.push_back(std::move(file));
  }
  return absl::OkStatus();
}

absl::Status convert_view(const fs::path& path, const SceneFileForm& form, SceneFile* scene) {
  if (form.has_camera()) {
    if (!form.camera().has_eye()) return invalid(path, "camera.eye: must be given");
    Camera camera;
    camera.eye = internal::vec3_from_proto(form.camera().eye());
    camera.target = internal::vec3_from_proto(form.camera().target());
    if (form.camera().has_up()) camera.up = internal::vec3_from_proto(form.camera().up());
    if (form.camera().fov_y_deg() != 0) camera.fov_y_deg = form.camera().fov_y_deg();
    scene->camera = camera;
  }
  scene->settings = internal::from_proto(form.settings());
  if (form.has_size()) scene->size = Size{form.size().width_px(), form.size().height_px()};
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SceneFile> read_scene_file(const fs::path& path) {
  const absl::StatusOr<std::string> text = read_text(path);
  if (!text.ok()) return text.status();
  const absl::StatusOr<SceneFileForm> form = parse(path, *text);
  if (!form.ok()) return form.status();
  if (const std::string field = first_output_field(*form); !field.empty()) {
    return invalid(path, fmt::format("{}: is set by the server, must not be given", field));
  }

  SceneFile scene{.display_name = form->scene().display_name()};
  if (form->scene().millimetres_per_unit() != 0) scene.millimetres_per_unit = form->scene().millimetres_per_unit();
  for (const auto convert : {convert_materials, convert_lights, convert_meshes, convert_view}) {
    if (absl::Status status = convert(path, *form, &scene); !status.ok()) return status;
  }
  return scene;
}

}  // namespace diaphane

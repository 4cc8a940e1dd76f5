#include "service/convert/scene.h"

#include "service/convert/check.h"

namespace diaphane::service {
namespace {

// From nanometres to kilometres; squares of what comes out are finite and above nothing in float.
constexpr double kSmallestUnit_mm = 1e-6;
constexpr double kLargestUnit_mm = 1e6;

}  // namespace

absl::StatusOr<scene::ScenePatch> from_proto(const v1::Scene& message) {
  absl::Status length = check_length("scene.display_name", message.display_name(), 256);
  if (!length.ok()) return length;
  const double millimetres = message.millimetres_per_unit() == 0 ? 1 : message.millimetres_per_unit();
  absl::Status range = check_range("scene.millimetres_per_unit", millimetres, kSmallestUnit_mm, kLargestUnit_mm);
  if (!range.ok()) return range;
  return scene::ScenePatch{message.display_name(), millimetres};
}

absl::StatusOr<scene::ScenePatch> from_proto(const v1::Scene& message, const google::protobuf::FieldMask& mask) {
  absl::Status known = check_mask(mask, {"display_name", "millimetres_per_unit"});
  if (!known.ok()) return known;
  absl::StatusOr<scene::ScenePatch> patch = from_proto(message);
  if (!patch.ok()) return patch;
  if (!names(mask, "display_name")) patch->display_name.reset();
  if (!names(mask, "millimetres_per_unit")) patch->millimetres_per_unit.reset();
  return patch;
}

void to_proto(const scene::SnapshotPtr& scene, v1::Scene& message) {
  message.set_name(scene->name);
  message.set_display_name(scene->display_name);
  message.set_millimetres_per_unit(scene->millimetres_per_unit);
  message.set_revision(scene->revision);
  message.set_mesh_count(static_cast<uint32_t>(scene->meshes.size()));
  message.set_material_count(static_cast<uint32_t>(scene->materials.size()));
  message.set_light_count(static_cast<uint32_t>(scene->lights.size()));
  message.set_texture_count(static_cast<uint32_t>(scene->textures.size()));
  message.set_has_environment(scene->environment != nullptr);
}

}  // namespace diaphane::service

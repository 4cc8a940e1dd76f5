#include "service/convert/material.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

constexpr float kLargestCoefficient = 1000;
constexpr float kBrightest = 0.999f;

/// OK when each of x, y, z is above 0, up to `highest`; else the error names the one that is not.
absl::Status check_above_zero(std::string_view field, const v1::Vec3& value, double highest) {
  const glm::vec3 v = service::from_proto(value);
  for (int axis = 0; axis < 3; ++axis) {
    // Written so that NaN fails too.
    if (!(v[axis] > 0 && v[axis] <= highest)) {
      return base::invalid_field(fmt::format("{}.{}", field, "xyz"[axis]), fmt::format("above 0, up to {:g}", highest),
                                 v[axis]);
    }
  }
  return absl::OkStatus();
}

/// As check_range(), with bounds that are floats as the fields are: in double, 0.999f is beyond 0.999.
absl::Status check_within(std::string_view field, float value, float lowest, float highest) {
  if (value >= lowest && value <= highest) return absl::OkStatus();
  return base::invalid_field(field, fmt::format("{}..{}", lowest, highest), fmt::format("{}", value));
}

absl::Status check_within(std::string_view field, const v1::Vec3& value, float lowest, float highest) {
  const glm::vec3 v = service::from_proto(value);
  for (int axis = 0; axis < 3; ++axis) {
    absl::Status within = check_within(fmt::format("{}.{}", field, "xyz"[axis]), v[axis], lowest, highest);
    if (!within.ok()) return within;
  }
  return absl::OkStatus();
}

/// `value`, or what is there already where it is 0.
absl::Status set_refractive_index(const char* field, float value, float* refractive_index) {
  if (value == 0) return absl::OkStatus();
  *refractive_index = value;
  return check_range(field, value, 1, 3);
}

template <typename Form>
absl::StatusOr<optics::MaterialForm> all_ok(const Form& form, std::initializer_list<absl::Status> checks) {
  for (const absl::Status& check : checks) {
    if (!check.ok()) return check;
  }
  return form;
}

absl::StatusOr<optics::MaterialForm> form_from_proto(const v1::Coefficients& message) {
  optics::Coefficients form{.absorption_mm = service::from_proto(message.absorption_mm()),
                            .reduced_scattering_mm = service::from_proto(message.reduced_scattering_mm())};
  return all_ok(form,
                {check_range("material.coefficients.absorption_mm", message.absorption_mm(), 0, kLargestCoefficient),
                 check_above_zero("material.coefficients.reduced_scattering_mm", message.reduced_scattering_mm(),
                                  kLargestCoefficient),
                 set_refractive_index("material.coefficients.refractive_index", message.refractive_index(),
                                      &form.refractive_index)});
}

absl::StatusOr<optics::MaterialForm> form_from_proto(const v1::DiffuseColor& message) {
  optics::DiffuseColor form{.color = service::from_proto(message.color()),
                            .mean_free_path_mm = service::from_proto(message.mean_free_path_mm())};
  return all_ok(form,
                {check_within("material.diffuse_color.color", message.color(), 0, kBrightest),
                 check_within("material.diffuse_color.mean_free_path_mm", message.mean_free_path_mm(), 0.001f, 1000),
                 set_refractive_index("material.diffuse_color.refractive_index", message.refractive_index(),
                                      &form.refractive_index)});
}

absl::Status check_scatters(const v1::Vec3& color) {
  if (color.x() != 0 || color.y() != 0 || color.z() != 0) return absl::OkStatus();
  return base::invalid_field("material.volume.multiscatter_color",
                             "above 0 in at least one channel: clear bodies are not drawn", "0, 0, 0");
}

absl::Status check_attenuates(const v1::Vec3& color) {
  if (color.x() != 1 || color.y() != 1 || color.z() != 1) return absl::OkStatus();
  return base::invalid_field("material.volume.attenuation_color",
                             "below 1 in at least one channel: clear bodies are not drawn", "1, 1, 1");
}

absl::StatusOr<optics::MaterialForm> form_from_proto(const v1::Volume& message) {
  optics::Volume form{.attenuation_color = service::from_proto(message.attenuation_color()),
                      .attenuation_distance_mm = message.attenuation_distance_mm(),
                      .multiscatter_color = service::from_proto(message.multiscatter_color()),
                      .scatter_anisotropy = message.scatter_anisotropy()};
  return all_ok(
      form,
      {check_above_zero("material.volume.attenuation_color", message.attenuation_color(), 1),
       check_attenuates(message.attenuation_color()),
       check_within("material.volume.attenuation_distance_mm", message.attenuation_distance_mm(), 1e-6f, 1e6f),
       check_within("material.volume.multiscatter_color", message.multiscatter_color(), 0, kBrightest),
       check_scatters(message.multiscatter_color()),
       check_within("material.volume.scatter_anisotropy", message.scatter_anisotropy(), -0.99f, 0.99f),
       set_refractive_index("material.volume.refractive_index", message.refractive_index(), &form.refractive_index)});
}

absl::StatusOr<optics::MaterialForm> form_from_proto(const v1::Material& message) {
  switch (message.model_case()) {
    case v1::Material::kPreset:
      if (!optics::find_preset(message.preset()).has_value()) {
        return base::invalid_field("material.preset", "a name that ListMaterialPresets lists", message.preset());
      }
      return optics::PresetName{message.preset()};
    case v1::Material::kCoefficients:
      return form_from_proto(message.coefficients());
    case v1::Material::kDiffuseColor:
      return form_from_proto(message.diffuse_color());
    case v1::Material::kVolume:
      return form_from_proto(message.volume());
    case v1::Material::MODEL_NOT_SET:
      break;
  }
  return base::invalid_field("material.model", "preset, coefficients, diffuse_color or volume", "none");
}

absl::StatusOr<std::optional<optics::Coat>> coat_from_proto(const v1::Material& message) {
  if (!message.has_coat()) return std::optional<optics::Coat>();
  absl::Status within = check_within("material.coat.roughness", message.coat().roughness(), 0, 1);
  if (!within.ok()) return within;
  return std::optional<optics::Coat>({.roughness = message.coat().roughness()});
}

absl::StatusOr<scene::SurfaceTextures> textures_from_proto(const v1::SurfaceTextures& message) {
  absl::Status within = check_range("material.textures.normal_scale", message.normal_scale(), 0, 4);
  if (!within.ok()) return within;
  return scene::SurfaceTextures{message.albedo(), message.normal(), message.roughness(),
                                message.normal_scale() == 0 ? 1.0f : message.normal_scale()};
}

void to_proto(const scene::SurfaceTextures& textures, v1::SurfaceTextures& message) {
  message.set_albedo(textures.albedo);
  message.set_normal(textures.normal);
  message.set_roughness(textures.roughness);
  message.set_normal_scale(textures.normal_scale);
}

absl::StatusOr<optics::Profile> from_proto(v1::Profile profile) {
  switch (profile) {
    case v1::PROFILE_UNSPECIFIED:
    case v1::PROFILE_DIPOLE:
      return optics::Profile::kDipole;
    case v1::PROFILE_BETTER_DIPOLE:
      return optics::Profile::kBetterDipole;
    case v1::PROFILE_NORMALIZED_DIFFUSION:
      return optics::Profile::kNormalizedDiffusion;
    default:
      return base::invalid_field("material.profile", "a value of Profile", static_cast<int>(profile));
  }
}

v1::Profile to_proto(optics::Profile profile) {
  switch (profile) {
    case optics::Profile::kBetterDipole:
      return v1::PROFILE_BETTER_DIPOLE;
    case optics::Profile::kNormalizedDiffusion:
      return v1::PROFILE_NORMALIZED_DIFFUSION;
    case optics::Profile::kDipole:
      break;
  }
  return v1::PROFILE_DIPOLE;
}

void to_proto(const optics::Coefficients& coefficients, v1::Coefficients& message) {
  service::to_proto(coefficients.absorption_mm, *message.mutable_absorption_mm());
  service::to_proto(coefficients.reduced_scattering_mm, *message.mutable_reduced_scattering_mm());
  message.set_refractive_index(coefficients.refractive_index);
}

void to_proto(const optics::DiffuseColor& form, v1::DiffuseColor& message) {
  service::to_proto(form.color, *message.mutable_color());
  service::to_proto(form.mean_free_path_mm, *message.mutable_mean_free_path_mm());
  message.set_refractive_index(form.refractive_index);
}

void to_proto(const optics::Volume& form, v1::Volume& message) {
  service::to_proto(form.attenuation_color, *message.mutable_attenuation_color());
  message.set_attenuation_distance_mm(form.attenuation_distance_mm);
  service::to_proto(form.multiscatter_color, *message.mutable_multiscatter_color());
  message.set_scatter_anisotropy(form.scatter_anisotropy);
  message.set_refractive_index(form.refractive_index);
}

void to_proto(const optics::MaterialForm& form, v1::Material& message) {
  if (const auto* preset = std::get_if<optics::PresetName>(&form)) {
    message.set_preset(preset->name);
  } else if (const auto* coefficients = std::get_if<optics::Coefficients>(&form)) {
    to_proto(*coefficients, *message.mutable_coefficients());
  } else if (const auto* color = std::get_if<optics::DiffuseColor>(&form)) {
    to_proto(*color, *message.mutable_diffuse_color());
  } else {
    to_proto(std::get<optics::Volume>(form), *message.mutable_volume());
  }
}

}  // namespace

absl::StatusOr<scene::NewMaterial> from_proto(const v1::Material& message) {
  auto form = form_from_proto(message);
  if (!form.ok()) return form.status();
  const auto profile = from_proto(message.profile());
  if (!profile.ok()) return profile.status();
  const auto coat = coat_from_proto(message);
  if (!coat.ok()) return coat.status();
  auto textures = textures_from_proto(message.textures());
  if (!textures.ok()) return textures.status();
  return scene::NewMaterial{*std::move(form), *profile, *coat, *std::move(textures)};
}

absl::StatusOr<scene::MaterialPatch> from_proto(const v1::UpdateMaterialRequest& message) {
  const google::protobuf::FieldMask& mask = message.update_mask();
  constexpr std::string_view kForms[] = {"model", "preset", "coefficients", "diffuse_color", "volume"};
  absl::Status known =
      check_mask(mask, {"model", "preset", "coefficients", "diffuse_color", "volume", "profile", "coat", "textures"});
  if (!known.ok()) return known;
  scene::MaterialPatch patch;
  if (std::any_of(std::begin(kForms), std::end(kForms), [&](std::string_view path) { return names(mask, path); })) {
    auto form = form_from_proto(message.material());
    if (!form.ok()) return form.status();
    patch.form = *std::move(form);
  }
  if (names(mask, "profile")) {
    const auto profile = from_proto(message.material().profile());
    if (!profile.ok()) return profile.status();
    patch.profile = *profile;
  }
  if (names(mask, "coat")) {
    const auto coat = coat_from_proto(message.material());
    if (!coat.ok()) return coat.status();
    patch.coat = *coat;
  }
  if (names(mask, "textures")) {
    auto textures = textures_from_proto(message.material().textures());
    if (!textures.ok()) return textures.status();
    patch.textures = *std::move(textures);
  }
  return patch;
}

void to_proto(const scene::Material& material, v1::Material& message) {
  message.set_name(material.name);
  to_proto(material.form, message);
  message.set_profile(to_proto(material.coefficients.profile));
  if (material.coat.has_value()) message.mutable_coat()->set_roughness(material.coat->roughness);
  if (material.textures.any()) to_proto(material.textures, *message.mutable_textures());
  to_proto(material.coefficients, *message.mutable_resolved());
  for (const std::string& warning : material.warnings) message.add_warnings(warning);
}

void to_proto(const scene::Changed<scene::Material>& changed, v1::MaterialResponse& message) {
  to_proto(changed.value, *message.mutable_material());
  message.set_scene_revision(changed.scene_revision);
}

void to_proto(const optics::MaterialPreset& preset, v1::MaterialPreset& message) {
  message.set_name(std::string(preset.name));
  to_proto(preset.coefficients, *message.mutable_coefficients());
  message.set_source(std::string(preset.source));
}

}  // namespace diaphane::service

#include "service/convert/material.h"

#include <string>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

constexpr float kLargestCoefficient = 1000;

absl::Status check_scattering(const glm::vec3& value) {
  for (int axis = 0; axis < 3; ++axis) {
    // Written so that NaN fails too.
    if (!(value[axis] > 0 && value[axis] <= kLargestCoefficient)) {
      return base::invalid_field(fmt::format("material.coefficients.reduced_scattering_mm.{}", "xyz"[axis]),
                                 "above 0, up to 1000", value[axis]);
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<optics::Coefficients> from_proto(const v1::Coefficients& message) {
  absl::Status absorption =
      check_range("material.coefficients.absorption_mm", message.absorption_mm(), 0, kLargestCoefficient);
  if (!absorption.ok()) return absorption;
  optics::Coefficients coefficients;
  coefficients.absorption_mm = service::from_proto(message.absorption_mm());
  coefficients.reduced_scattering_mm = service::from_proto(message.reduced_scattering_mm());
  absl::Status scattering = check_scattering(coefficients.reduced_scattering_mm);
  if (!scattering.ok()) return scattering;
  if (message.refractive_index() != 0) {
    absl::Status index = check_range("material.coefficients.refractive_index", message.refractive_index(), 1, 3);
    if (!index.ok()) return index;
    coefficients.refractive_index = message.refractive_index();
  }
  return coefficients;
}

void to_proto(const optics::Coefficients& coefficients, v1::Coefficients& message) {
  service::to_proto(coefficients.absorption_mm, *message.mutable_absorption_mm());
  service::to_proto(coefficients.reduced_scattering_mm, *message.mutable_reduced_scattering_mm());
  message.set_refractive_index(coefficients.refractive_index);
}

}  // namespace

absl::StatusOr<scene::MaterialModel> from_proto(const v1::Material& message) {
  switch (message.model_case()) {
    case v1::Material::kPreset: {
      const auto preset = optics::find_preset(message.preset());
      if (!preset.has_value()) {
        return base::invalid_field("material.preset", "a name that ListMaterialPresets lists", message.preset());
      }
      return scene::MaterialModel{std::string(preset->name), preset->coefficients};
    }
    case v1::Material::kCoefficients: {
      const auto coefficients = from_proto(message.coefficients());
      if (!coefficients.ok()) return coefficients.status();
      return scene::MaterialModel{{}, *coefficients};
    }
    case v1::Material::MODEL_NOT_SET:
      break;
  }
  return base::invalid_field("material.model", "preset or coefficients", "neither");
}

absl::Status check_material_mask(const google::protobuf::FieldMask& mask) {
  return check_mask(mask, {"model", "preset", "coefficients"});
}

void to_proto(const scene::Material& material, v1::Material& message) {
  message.set_name(material.name);
  if (material.preset.empty()) {
    to_proto(material.coefficients, *message.mutable_coefficients());
  } else {
    message.set_preset(material.preset);
  }
  to_proto(material.coefficients, *message.mutable_resolved());
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

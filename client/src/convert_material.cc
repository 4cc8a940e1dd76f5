// Materials to the contract's messages and back.
#include "convert.h"

namespace diaphane::internal {
namespace {

static_assert(int{v1::PROFILE_DIPOLE} == static_cast<int>(Profile::kDipole));
static_assert(int{v1::PROFILE_BETTER_DIPOLE} == static_cast<int>(Profile::kBetterDipole));
static_assert(int{v1::PROFILE_NORMALIZED_DIFFUSION} == static_cast<int>(Profile::kNormalizedDiffusion));

v1::DiffuseColor form_to_proto(const DiffuseColor& color) {
  v1::DiffuseColor message;
  *message.mutable_color() = to_proto(color.color);
  *message.mutable_mean_free_path_mm() = to_proto(color.mean_free_path_mm);
  message.set_refractive_index(color.refractive_index);
  return message;
}

v1::Volume form_to_proto(const Volume& volume) {
  v1::Volume message;
  *message.mutable_attenuation_color() = to_proto(volume.attenuation_color);
  message.set_attenuation_distance_mm(volume.attenuation_distance_mm);
  *message.mutable_multiscatter_color() = to_proto(volume.multiscatter_color);
  message.set_scatter_anisotropy(volume.scatter_anisotropy);
  message.set_refractive_index(volume.refractive_index);
  return message;
}

DiffuseColor form_from_proto(const v1::DiffuseColor& message) {
  DiffuseColor color{rgb_from_proto(message.color()), rgb_from_proto(message.mean_free_path_mm())};
  if (message.refractive_index() != 0) color.refractive_index = message.refractive_index();
  return color;
}

Volume form_from_proto(const v1::Volume& message) {
  Volume volume{rgb_from_proto(message.attenuation_color()), message.attenuation_distance_mm(),
                rgb_from_proto(message.multiscatter_color()), message.scatter_anisotropy()};
  if (message.refractive_index() != 0) volume.refractive_index = message.refractive_index();
  return volume;
}

}  // namespace

v1::Coefficients to_proto(const Coefficients& coefficients) {
  v1::Coefficients message;
  *message.mutable_absorption_mm() = to_proto(coefficients.absorption_mm);
  *message.mutable_reduced_scattering_mm() = to_proto(coefficients.reduced_scattering_mm);
  message.set_refractive_index(coefficients.refractive_index);
  return message;
}

v1::Material to_proto(const Material& material) {
  v1::Material message;
  if (const auto* preset = std::get_if<std::string>(&material.model)) {
    message.set_preset(*preset);
  } else if (const auto* coefficients = std::get_if<Coefficients>(&material.model)) {
    *message.mutable_coefficients() = to_proto(*coefficients);
  } else if (const auto* color = std::get_if<DiffuseColor>(&material.model)) {
    *message.mutable_diffuse_color() = form_to_proto(*color);
  } else {
    *message.mutable_volume() = form_to_proto(std::get<Volume>(material.model));
  }
  message.set_profile(static_cast<v1::Profile>(material.profile));
  if (material.coat) message.mutable_coat()->set_roughness(material.coat->roughness);
  const SurfaceTextures& textures = material.textures;
  if (textures.albedo) message.mutable_textures()->set_albedo(textures.albedo->name);
  if (textures.normal) message.mutable_textures()->set_normal(textures.normal->name);
  if (textures.roughness) message.mutable_textures()->set_roughness(textures.roughness->name);
  if (message.has_textures()) message.mutable_textures()->set_normal_scale(textures.normal_scale);
  return message;
}

Coefficients from_proto(const v1::Coefficients& message) {
  Coefficients coefficients{rgb_from_proto(message.absorption_mm()), rgb_from_proto(message.reduced_scattering_mm())};
  if (message.refractive_index() != 0) coefficients.refractive_index = message.refractive_index();
  return coefficients;
}

Material from_proto(const v1::Material& message) {
  Material material;
  if (message.has_coefficients()) {
    material.model = from_proto(message.coefficients());
  } else if (message.has_diffuse_color()) {
    material.model = form_from_proto(message.diffuse_color());
  } else if (message.has_volume()) {
    material.model = form_from_proto(message.volume());
  } else {
    material.model = message.preset();
  }
  if (message.profile() != v1::PROFILE_UNSPECIFIED) material.profile = static_cast<Profile>(message.profile());
  if (message.has_coat()) material.coat = Coat{message.coat().roughness()};
  const v1::SurfaceTextures& textures = message.textures();
  if (!textures.albedo().empty()) material.textures.albedo = TextureHandle{textures.albedo()};
  if (!textures.normal().empty()) material.textures.normal = TextureHandle{textures.normal()};
  if (!textures.roughness().empty()) material.textures.roughness = TextureHandle{textures.roughness()};
  if (textures.normal_scale() != 0) material.textures.normal_scale = textures.normal_scale();
  return material;
}

MaterialInfo info_from_proto(const v1::Material& message) {
  return {{message.name()},
          from_proto(message),
          from_proto(message.resolved()),
          {message.warnings().begin(), message.warnings().end()}};
}

MaterialPreset from_proto(const v1::MaterialPreset& message) {
  return {message.name(), from_proto(message.coefficients()), message.source()};
}

}  // namespace diaphane::internal

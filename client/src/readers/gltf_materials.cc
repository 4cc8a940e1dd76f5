#include "readers/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"
#include "readers/gltf_buffers.h"
#include "readers/image.h"

namespace diaphane::readers {
namespace {

using nlohmann::json;

constexpr const char* kLists[] = {"materials", "textures", "images", "samplers"};
constexpr double kMillimetresPerMetre = 1000;
constexpr double kBrightest = 0.95;  // a body that keeps nothing would carry light all over
constexpr float kMeanFreePath_mm = 1;
constexpr double kGltfIor = 1.5;
constexpr int kClampToEdge = 33071;

const json& member(const json& object, const char* name) {
  static const json nothing = json::object();
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

const json& extension(const json& object, const char* name) { return member(member(object, "extensions"), name); }

double number(const json& object, const char* name, double otherwise, double lowest, double highest) {
  const json& value = member(object, name);
  return std::clamp(value.is_number() ? value.get<double>() : otherwise, lowest, highest);
}

int integer(const json& object, const char* name, int otherwise) {
  const json& value = member(object, name);
  return value.is_number_integer() ? value.get<int>() : otherwise;
}

/// At least `count` numbers of an array, each brought within the range; `otherwise` for what is missing.
template <size_t count>
std::array<double, count> numbers(const json& object, const char* name, double otherwise, double lowest,
                                  double highest) {
  std::array<double, count> values;
  values.fill(otherwise);
  const json& array = member(object, name);
  if (!array.is_array() || array.size() < count) return values;
  for (size_t i = 0; i < count; ++i) {
    if (array[i].is_number()) values[i] = std::clamp(array[i].get<double>(), lowest, highest);
  }
  return values;
}

Rgb rgb(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

const json* element(const json& looks, const char* list, int index) {
  const json& elements = member(looks, list);
  const bool there = index >= 0 && static_cast<size_t>(index) < elements.size();
  return there && elements[static_cast<size_t>(index)].is_object() ? &elements[static_cast<size_t>(index)] : nullptr;
}

}  // namespace

json take_gltf_looks(json& root) {
  json looks = json::object();
  for (const char* list : kLists) {
    const auto found = root.find(list);
    looks[list] = json::array();
    if (found == root.end()) continue;
    if (found->is_array()) looks[list] = std::move(*found);
    root.erase(list);
  }
  return looks;
}

void GltfMaterials::warn(const std::string& text) {
  if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(text);
}

GltfMaterials::Picture GltfMaterials::picture_at(const json& parent, const char* name) {
  const json& info = member(parent, name);
  Picture picture{integer(info, "index", -1), integer(info, "texCoord", 0), number(info, "scale", 1, 0, 4), {}};
  const json& transform = extension(info, "KHR_texture_transform");
  picture.set = integer(transform, "texCoord", picture.set);
  const auto offset = numbers<2>(transform, "offset", 0, -1e6, 1e6);
  const auto scale = numbers<2>(transform, "scale", 1, -1e6, 1e6);
  picture.transform = {{offset[0], offset[1]}, number(transform, "rotation", 0, -1e6, 1e6), {scale[0], scale[1]}};
  return picture;
}

std::optional<GltfMaterials::Use> GltfMaterials::use(int index) {
  if (index < 0) return std::nullopt;
  const auto [known, is_new] = uses_.try_emplace(index);
  if (!is_new) return known->second;
  const json* material = element(looks_, "materials", index);
  if (material == nullptr) {
    warn("left out: materials that the file does not have");
    return std::nullopt;
  }
  FileMaterial made;
  const json& name = member(*material, "name");
  if (name.is_string()) made.name = in_quotes(name.get_ref<const std::string&>());
  const std::string where = fmt::format("material {}", index);
  read_body(*material, made);
  read_coat(*material, made);

  const json& base = member(*material, "pbrMetallicRoughness");
  const json& clearcoat = extension(*material, "KHR_materials_clearcoat");
  const bool coated = number(clearcoat, "clearcoatFactor", 0, 0, 1) >= 0.5;
  const Picture albedo = picture_at(base, "baseColorTexture");
  const Picture normal =
      coated ? picture_at(clearcoat, "clearcoatNormalTexture") : picture_at(*material, "normalTexture");
  const Picture roughness =
      coated ? picture_at(clearcoat, "clearcoatRoughnessTexture") : picture_at(base, "metallicRoughnessTexture");
  Use use;
  bool laid = false;
  made.albedo = take_picture(albedo, true, laid, use, where + " base colour");
  made.normal = take_picture(normal, false, laid, use, where + " normals");
  made.roughness = take_picture(roughness, false, laid, use, where + " roughness");
  made.normal_scale = static_cast<float>(normal.scale);
  if (normal.scale == 0) made.normal.reset();
  use.material = materials_.size();
  materials_.push_back(std::move(made));
  known->second = use;
  return use;
}

void GltfMaterials::read_body(const json& material, FileMaterial& out) const {
  const auto ior = static_cast<float>(number(extension(material, "KHR_materials_ior"), "ior", kGltfIor, 1, 3));
  const json& volume = extension(material, "KHR_materials_volume");
  const json& scatter = extension(material, "KHR_materials_volume_scatter");
  const auto attenuation = numbers<3>(volume, "attenuationColor", 1, 1e-6, 1);
  const auto multiscatter = numbers<3>(scatter, "multiscatterColor", 0, 0, 0.999);
  const double distance_m = number(volume, "attenuationDistance", 0, 0, 1e9);
  const bool attenuates = distance_m > 0 && *std::min_element(attenuation.begin(), attenuation.end()) < 1;
  if (attenuates && *std::max_element(multiscatter.begin(), multiscatter.end()) > 0) {
    Volume form;
    form.attenuation_color = rgb(attenuation);
    form.attenuation_distance_mm = static_cast<float>(std::clamp(distance_m * kMillimetresPerMetre, 1e-6, 1e6));
    form.multiscatter_color = rgb(multiscatter);
    form.scatter_anisotropy = static_cast<float>(number(scatter, "scatterAnisotropy", 0, -0.99, 0.99));
    form.refractive_index = ior;
    out.material.model = form;
    return;
  }
  const json& base = member(material, "pbrMetallicRoughness");
  DiffuseColor form;
  form.color = rgb(numbers<3>(base, "baseColorFactor", 1, 0, 1));
  for (float* channel : {&form.color.r, &form.color.g, &form.color.b}) {
    *channel = std::min(*channel, static_cast<float>(kBrightest));
  }
  form.mean_free_path_mm = {kMeanFreePath_mm, kMeanFreePath_mm, kMeanFreePath_mm};
  form.refractive_index = ior;
  out.material.model = form;
}

// glTF's roughness is the root of alpha.
void GltfMaterials::read_coat(const json& material, FileMaterial& out) {
  const json& base = member(material, "pbrMetallicRoughness");
  const json& clearcoat = extension(material, "KHR_materials_clearcoat");
  double root = number(base, "roughnessFactor", 1, 0, 1);
  if (number(clearcoat, "clearcoatFactor", 0, 0, 1) >= 0.5) {
    root = number(clearcoat, "clearcoatRoughnessFactor", 0, 0, 1);
  } else if (base.is_object() && number(base, "metallicFactor", 1, 0, 1) > 0.5 && base.contains("metallicFactor")) {
    warn("left out: metal; it is drawn as a body with a coat");
  }
  out.material.coat = Coat{static_cast<float>(root * root)};
  if (member(material, "alphaMode").is_string() && material["alphaMode"] != "OPAQUE") {
    warn("left out: alpha; all is drawn opaque");
  }
  if (!member(material, "emissiveTexture").empty()) warn("left out: emission");
}

/// The first picture settles how texture coordinates are read; what wants them otherwise is left out.
std::optional<size_t> GltfMaterials::take_picture(const Picture& picture, bool srgb, bool& laid, Use& use,
                                                  const std::string& where) {
  if (picture.texture < 0) return std::nullopt;
  if (!laid) {
    use.texture_coordinate_set = picture.set;
    use.transform = picture.transform;
  } else if (picture.set != use.texture_coordinate_set || picture.transform != use.transform) {
    warn(fmt::format("left out: {}, whose texture coordinates are others", where));
    return std::nullopt;
  }
  const std::optional<size_t> texture = texture_of(picture.texture, srgb, where);
  laid = laid || texture.has_value();
  return texture;
}

std::optional<size_t> GltfMaterials::texture_of(int index, bool srgb, const std::string& where) {
  const json* texture = element(looks_, "textures", index);
  if (texture == nullptr) {
    warn(fmt::format("left out: {}, a texture that the file does not have", where));
    return std::nullopt;
  }
  static const json nothing = json::object();
  const json* sampler = element(looks_, "samplers", integer(*texture, "sampler", -1));
  const bool clamp_u = integer(sampler == nullptr ? nothing : *sampler, "wrapS", 0) == kClampToEdge;
  const bool clamp_v = integer(sampler == nullptr ? nothing : *sampler, "wrapT", 0) == kClampToEdge;
  const int image = integer(extension(*texture, "EXT_texture_webp"), "source", integer(*texture, "source", -1));
  const auto [known, is_new] = textures_of_.try_emplace({image, srgb, clamp_u, clamp_v});
  if (!is_new) return known->second;
  absl::StatusOr<TextureData> data = decode(image);
  if (!data.ok()) {
    warn(fmt::format("left out: {}: {}", where, std::string(data.status().message())));
    return std::nullopt;
  }
  pixels_left_ -= uint64_t{data->width_px} * data->height_px;
  data->srgb = srgb;
  data->clamp_u = clamp_u;
  data->clamp_v = clamp_v;
  known->second = textures_.size();
  textures_.push_back(*std::move(data));
  return known->second;
}

absl::StatusOr<TextureData> GltfMaterials::decode(int index) {
  Source picture = source_;
  picture.name = fmt::format("image {}", index);
  const json* image = element(looks_, "images", index);
  if (image == nullptr) return picture.malformed("is not there");
  const int view = integer(*image, "bufferView", -1);
  if (view >= 0) {
    const absl::StatusOr<std::string_view> bytes = accessors_.view_bytes(view, picture.name);
    if (!bytes.ok()) return bytes.status();
    return decode_image(*bytes, pixels_left_, picture);
  }
  const json& uri = member(*image, "uri");
  if (!uri.is_string()) return picture.malformed("has neither bufferView nor uri");
  const absl::StatusOr<std::string> bytes = load_gltf_uri(uri.get_ref<const std::string&>(), picture);
  if (!bytes.ok()) return bytes.status();
  return decode_image(*bytes, pixels_left_, picture);
}

void apply(const GltfTextureTransform& transform, std::vector<TextureCoordinate>& coordinates) {
  if (transform == GltfTextureTransform()) return;
  const double cosine = std::cos(transform.rotation), sine = std::sin(transform.rotation);
  for (TextureCoordinate& c : coordinates) {
    const double u = transform.scale[0] * c.u, v = transform.scale[1] * c.v;
    c.u = static_cast<float>(cosine * u + sine * v + transform.offset[0]);
    c.v = static_cast<float>(cosine * v - sine * u + transform.offset[1]);
  }
}

}  // namespace diaphane::readers

// What glTF says that primitives are made of.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/readers.h"
#include "nlohmann/json.hpp"
#include "readers/gltf_accessor.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Moves what is read here out of a document's JSON, where tinygltf would read it without care: materials, textures,
/// images and samplers, each an array.
nlohmann::json take_gltf_looks(nlohmann::json& root);

/// KHR_texture_transform.
struct GltfTextureTransform {
  double offset[2] = {0, 0};
  double rotation = 0;  ///< radians, counter-clockwise as one sees the picture
  double scale[2] = {1, 1};
  friend bool operator==(const GltfTextureTransform&, const GltfTextureTransform&) = default;
};

/// Reads materials as primitives ask for them, each once, and pictures as materials do. Nothing in here refuses a file:
/// what cannot be read is left out with a warning. Not thread-safe; what it is made from outlives it.
class GltfMaterials {
 public:
  /// Which material, and how its pictures lie on the mesh.
  struct Use {
    size_t material = 0;             ///< into materials()
    int texture_coordinate_set = 0;  ///< TEXCOORD_n
    GltfTextureTransform transform;
  };

  GltfMaterials(const nlohmann::json& looks, GltfAccessors& accessors, const Source& source)
      : looks_(looks), accessors_(accessors), source_(source), pixels_left_(source.limits.max_texture_pixels) {}

  /// Material `index` of the file; none where there is no such material.
  std::optional<Use> use(int index);

  std::vector<FileMaterial> take_materials() { return std::move(materials_); }
  std::vector<TextureData> take_textures() { return std::move(textures_); }
  std::vector<std::string> take_warnings() { return std::move(warnings_); }

 private:
  struct Picture {
    int texture = -1;
    int set = 0;
    double scale = 1;
    GltfTextureTransform transform;
  };

  static Picture picture_at(const nlohmann::json& parent, const char* name);
  void read_body(const nlohmann::json& material, FileMaterial& out) const;
  void read_coat(const nlohmann::json& material, FileMaterial& out);
  std::optional<size_t> take_picture(const Picture& picture, bool srgb, bool& laid, Use& use, const std::string& where);
  std::optional<size_t> texture_of(int texture, bool srgb, const std::string& where);
  absl::StatusOr<TextureData> decode(int image);
  void warn(const std::string& text);

  const nlohmann::json& looks_;
  GltfAccessors& accessors_;
  const Source& source_;
  uint64_t pixels_left_;
  std::map<int, std::optional<Use>> uses_;  ///< by the file's index
  std::map<std::tuple<int, bool, bool, bool>, std::optional<size_t>> textures_of_;
  std::vector<FileMaterial> materials_;
  std::vector<TextureData> textures_;
  std::vector<std::string> warnings_;
};

/// Moves coordinates as `transform` says.
void apply(const GltfTextureTransform& transform, std::vector<TextureCoordinate>& coordinates);

}  // namespace diaphane::readers

#include "readers/gltf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fmt/format.h"
#include "readers/colour.h"
#include "readers/gltf_accessor.h"
#include "readers/gltf_buffers.h"
#include "readers/gltf_document.h"
#include "readers/gltf_draco.h"
#include "readers/gltf_materials.h"
#include "readers/gltf_matrix.h"
#include "readers/gltf_model.h"
#include "readers/gltf_scene.h"
#include "readers/gltf_skin.h"
#include "readers/mesh_builder.h"

namespace diaphane::readers {
namespace {

constexpr double kMillimetresPerMetre = 1000;

bool is_normal(const Vec3& v) {
  return std::abs(v.x) <= kLargestNormal && std::abs(v.y) <= kLargestNormal && std::abs(v.z) <= kLargestNormal;
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, const GltfExtensions& extensions, const GltfBuffers& buffers,
             const nlohmann::json& looks, const Source& source, GltfUse use)
      : use_(use),
        model_(model),
        extensions_(extensions),
        accessors_(model, extensions, buffers, source),
        materials_(looks, accessors_, source),
        skins_(model, placement_, accessors_, source),
        source_(source),
        most_bytes_(24 * source.limits.max_vertices + 12 * source.limits.max_triangles) {}

  absl::StatusOr<LoadedFile> read() {
    file_.millimetres_per_unit = kMillimetresPerMetre;
    absl::StatusOr<GltfPlacement> placement = place_gltf_meshes(model_, extensions_, accessors_, source_);
    if (!placement.ok()) return placement.status();
    placement_ = *std::move(placement);
    for (const GltfInstance& instance : placement_.instances) {
      const tinygltf::Mesh& mesh = model_.meshes[instance.mesh];
      for (size_t primitive = 0; primitive < mesh.primitives.size(); ++primitive) {
        if (++primitives_ > source_.limits.max_nodes) {
          return source_.over_limit("primitives placed by nodes", primitives_, source_.limits.max_nodes);
        }
        const absl::Status status = read_primitive(instance, primitive);
        if (!status.ok()) return status;
      }
    }
    for (const auto& [what, count] : skipped_) file_.warnings.push_back(fmt::format("left out: {} {}", count, what));
    for (std::string& warning : materials_.take_warnings()) file_.warnings.push_back(std::move(warning));
    file_.materials = materials_.take_materials();
    file_.textures = materials_.take_textures();
    if (!file_.meshes.empty()) return std::move(file_);
    return nothing_to_render(source_, vertices_, fmt::format("{}", fmt::join(file_.warnings, ", ")));
  }

 private:
  absl::Status read_primitive(const GltfInstance& instance, size_t index) {
    const tinygltf::Mesh& mesh = model_.meshes[instance.mesh];
    const tinygltf::Primitive& primitive = mesh.primitives[index];
    if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      return source_.malformed(fmt::format("mode {}", primitive.mode), where(instance, index), "must be 0..6");
    }
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      ++skipped_["primitives of points or lines"];
      return absl::OkStatus();
    }
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
      ++skipped_["primitives without positions"];
      return absl::OkStatus();
    }

    const int skin = instance.node >= 0 ? model_.nodes[static_cast<size_t>(instance.node)].skin : -1;
    const absl::StatusOr<bool> is_posed = skins_.poses(skin, primitive);
    if (!is_posed.ok()) return is_posed.status();
    if (skin >= 0 && !*is_posed) ++skipped_["skins that cannot be applied"];
    if (use_ == GltfUse::kMeshes && !*is_posed && determinant(instance.scene_from_mesh) == 0) {
      ++skipped_["primitives of no volume (scale 0)"];
      return absl::OkStatus();
    }

    MeshData data;
    absl::Status status = decompress(instance, index);
    if (status.ok()) status = read_vertices(primitive, position->second, data);
    if (status.ok() && use_ != GltfUse::kPose) status = read_looks(primitive, data);
    if (status.ok()) status = apply_morphs(instance, primitive, data);
    if (status.ok()) status = read_triangles(primitive, where(instance, index), data);
    if (status.ok() && *is_posed) status = skins_.pose(skin, primitive, where(instance, index), data);
    if (status.ok() && !*is_posed && use_ != GltfUse::kMeshes) place_in_scene(instance.scene_from_mesh, data);
    if (status.ok()) status = check_vertices(data, where(instance, index));
    if (!status.ok()) return status;
    if (data.triangles.empty()) {
      ++skipped_["primitives without a triangle"];
      return absl::OkStatus();
    }
    data.name = name_of(instance, index);
    if (!*is_posed && use_ == GltfUse::kMeshes) {
      std::transform(instance.scene_from_mesh.begin(), instance.scene_from_mesh.end(), data.scene_from_mesh.begin(),
                     [](double value) { return static_cast<float>(value); });
    }
    file_.meshes.push_back(std::move(data));
    return absl::OkStatus();
  }

  static void place_in_scene(const Matrix& m, MeshData& data) {
    const auto times = [](const auto& c, size_t rows, const Vec3& v) {
      const auto row = [&](size_t r) { return c[r] * v.x + c[rows + r] * v.y + c[2 * rows + r] * v.z; };
      return std::array<double, 3>{row(0), row(1), row(2)};
    };
    for (Vec3& p : data.positions) {
      const auto [x, y, z] = times(m, 4, p);
      p = {static_cast<float>(x + m[12]), static_cast<float>(y + m[13]), static_cast<float>(z + m[14])};
    }
    const std::array<double, 9> turn = normal_matrix(m);
    for (Vec3& n : data.normals) {
      const auto [x, y, z] = times(turn, 3, n);
      const double length = std::hypot(x, y, z);
      n = length > 0
              ? Vec3{static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)}
              : Vec3{};
    }
    if (determinant(m) >= 0) return;
    for (size_t t = 0; t + 2 < data.triangles.size(); t += 3) std::swap(data.triangles[t + 1], data.triangles[t + 2]);
  }

  // Puts what Draco compressed in the place of the primitive's accessors.
  absl::Status decompress(const GltfInstance& instance, size_t index) {
    accessors_.replace({});
    const auto draco = extensions_.draco_of_primitive.find({instance.mesh, index});
    if (draco == extensions_.draco_of_primitive.end()) return absl::OkStatus();
    const std::string place = where(instance, index);
    const absl::StatusOr<std::string_view> compressed = accessors_.view_bytes(draco->second.buffer_view, place);
    if (!compressed.ok()) return compressed.status();
    absl::StatusOr<GltfReplacedAccessors> decoded = decode_draco(model_, model_.meshes[instance.mesh].primitives[index],
                                                                 draco->second, *compressed, place, source_);
    if (decoded.ok()) accessors_.replace(*std::move(decoded));
    return decoded.status();
  }

  static std::string where(const GltfInstance& instance, size_t primitive) {
    return fmt::format("mesh {} primitive {}", instance.mesh, primitive);
  }

  std::string name_of(const GltfInstance& instance, size_t primitive) const {
    const tinygltf::Mesh& mesh = model_.meshes[instance.mesh];
    std::string name = instance.node >= 0 ? model_.nodes[static_cast<size_t>(instance.node)].name : std::string();
    if (name.empty()) name = mesh.name;
    if (name.empty()) name = fmt::format("mesh {}", instance.mesh);
    name = tidy_name(name);
    return mesh.primitives.size() > 1 ? fmt::format("{}/{}", name, primitive) : name;
  }

  absl::Status read_vertices(const tinygltf::Primitive& primitive, int position, MeshData& data) {
    const absl::StatusOr<uint64_t> count = accessors_.count(position);
    if (!count.ok()) return count.status();
    const uint64_t most = source_.limits.max_vertices;
    if (*count > most - vertices_) return source_.over_limit("vertices or more", most + 1, most);
    vertices_ += *count;
    const absl::Status status = spend_bytes(primitive, *count);
    if (!status.ok()) return status;
    absl::StatusOr<std::vector<Vec3>> positions = accessors_.read_vec3(position, *count);
    if (!positions.ok()) return positions.status();
    data.positions = *std::move(positions);
    const auto normal = primitive.attributes.find("NORMAL");
    if (normal == primitive.attributes.end()) return absl::OkStatus();
    absl::StatusOr<std::vector<Vec3>> normals = accessors_.read_vec3(normal->second, *count);
    if (!normals.ok()) return normals.status();
    data.normals = *std::move(normals);
    return absl::OkStatus();
  }

  // A bound on what instances multiply: as much as positions and normals of the most vertices and triangles take.
  absl::Status spend_bytes(const tinygltf::Primitive& primitive, uint64_t vertices) {
    uint64_t bytes = sizeof(Vec3);
    if (primitive.attributes.contains("NORMAL")) bytes += sizeof(Vec3);
    if (primitive.attributes.contains("COLOR_0")) bytes += sizeof(Rgb);
    if (primitive.attributes.contains("TEXCOORD_0")) bytes += sizeof(TextureCoordinate);
    bytes_ += bytes * vertices;
    return bytes_ <= most_bytes_ ? absl::OkStatus() : source_.over_limit("bytes of vertices", bytes_, most_bytes_);
  }

  absl::Status read_looks(const tinygltf::Primitive& primitive, MeshData& data) {
    const uint64_t count = data.positions.size();
    if (const auto colour = primitive.attributes.find("COLOR_0"); colour != primitive.attributes.end()) {
      absl::StatusOr<std::vector<Rgb>> colours = accessors_.read_colours(colour->second, count);
      if (!colours.ok()) return colours.status();
      make_linear(*colours, ColourCoding::kLinear);
      data.colors = *std::move(colours);
    }
    const std::optional<GltfMaterials::Use> use = materials_.use(primitive.material);
    if (use) data.material = use->material;
    const std::string set = fmt::format("TEXCOORD_{}", use ? use->texture_coordinate_set : 0);
    if (const auto texture = primitive.attributes.find(set); texture != primitive.attributes.end()) {
      absl::StatusOr<std::vector<TextureCoordinate>> coordinates =
          accessors_.read_texture_coordinates(texture->second, count);
      if (!coordinates.ok()) return coordinates.status();
      data.texture_coordinates = *std::move(coordinates);
      if (use) apply(use->transform, data.texture_coordinates);
    }
    return absl::OkStatus();
  }

  // The rest pose is base + Σ weight · target, glTF 2.0 section 3.7.2.2; the node's weights go before the mesh's.
  absl::Status apply_morphs(const GltfInstance& instance, const tinygltf::Primitive& primitive, MeshData& data) {
    const std::vector<double>* weights = &model_.meshes[instance.mesh].weights;
    if (instance.node >= 0 && !model_.nodes[static_cast<size_t>(instance.node)].weights.empty()) {
      weights = &model_.nodes[static_cast<size_t>(instance.node)].weights;
    }
    for (size_t i = 0; i < std::min(weights->size(), primitive.targets.size()); ++i) {
      const double weight = (*weights)[i];
      if (weight == 0) continue;
      const auto& target = primitive.targets[i];
      absl::Status status = add_displacements(target, "POSITION", weight, data.positions);
      if (status.ok() && !data.normals.empty()) status = add_displacements(target, "NORMAL", weight, data.normals);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status add_displacements(const std::map<std::string, int>& target, const char* attribute, double weight,
                                 std::vector<Vec3>& values) {
    const auto accessor = target.find(attribute);
    if (accessor == target.end()) return absl::OkStatus();
    const absl::StatusOr<std::vector<Vec3>> displacements = accessors_.read_vec3(accessor->second, values.size(), true);
    if (!displacements.ok()) return displacements.status();
    for (size_t i = 0; i < values.size(); ++i) {
      values[i].x += static_cast<float>(weight * (*displacements)[i].x);
      values[i].y += static_cast<float>(weight * (*displacements)[i].y);
      values[i].z += static_cast<float>(weight * (*displacements)[i].z);
    }
    return absl::OkStatus();
  }

  absl::Status check_vertices(MeshData& data, std::string_view where) {
    for (size_t i = 0; i < data.positions.size(); ++i) {
      const Vec3& p = data.positions[i];
      if (!is_finite(p)) {
        return source_.malformed(fmt::format("position {} is {}, {}, {}", i, p.x, p.y, p.z), where, "must be finite");
      }
    }
    for (Vec3& normal : data.normals) {
      if (is_normal(normal)) continue;
      normal = {};
      ++skipped_["normals that are not finite or beyond 1e18"];
    }
    for (TextureCoordinate& coordinate : data.texture_coordinates) {
      if (is_texture_coordinate(coordinate.u, coordinate.v)) continue;
      coordinate = {};
      ++skipped_["texture coordinates that are not finite or beyond 1e6"];
    }
    return absl::OkStatus();
  }

  absl::Status read_triangles(const tinygltf::Primitive& primitive, std::string_view where, MeshData& data) {
    uint64_t corners = data.positions.size();
    if (primitive.indices >= 0) {
      const absl::StatusOr<uint64_t> count = accessors_.count(primitive.indices);
      if (!count.ok()) return count.status();
      corners = *count;
    }
    const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    const uint64_t triangles = list ? corners / 3 : std::max<uint64_t>(corners, 2) - 2;
    const uint64_t most = source_.limits.max_triangles;
    if (triangles > most - triangles_) return source_.over_limit("triangles or more", most + 1, most);
    triangles_ += triangles;
    if (list && corners % 3 != 0) ++skipped_["incomplete triangles at the end of a primitive"];

    std::vector<uint32_t> indices;
    if (primitive.indices >= 0) {
      absl::StatusOr<std::vector<uint32_t>> read = accessors_.read_indices(primitive.indices, corners);
      if (!read.ok()) return read.status();
      indices = *std::move(read);
      for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= data.positions.size()) {
          return source_.malformed(fmt::format("index {} is {}", i, indices[i]), where,
                                   data.positions.empty() ? "there are no vertices"
                                                          : fmt::format("must be 0..{}", data.positions.size() - 1));
        }
      }
    }
    const auto corner = [&indices](uint64_t i) { return indices.empty() ? static_cast<uint32_t>(i) : indices[i]; };
    data.triangles.reserve(3 * triangles);
    for (uint64_t t = 0; t < triangles; ++t) {
      // Strips turn every other triangle round; fans go round their first corner (glTF 2.0 section 3.7.2.1).
      std::array<uint32_t, 3> triangle;
      if (list) {
        triangle = {corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)};
      } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        triangle = {corner(t), corner(t + 1 + t % 2), corner(t + 2 - t % 2)};
      } else {
        triangle = {corner(t + 1), corner(t + 2), corner(0)};
      }
      const auto [a, b, c] = triangle;
      if (a != b && b != c && c != a) {
        data.triangles.insert(data.triangles.end(), {a, b, c});
      } else if (primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP) {  // strips are stitched together with them
        ++skipped_["triangles with fewer than three different corners"];
      }
    }
    return absl::OkStatus();
  }

  const GltfUse use_;
  const tinygltf::Model& model_;
  const GltfExtensions& extensions_;
  GltfPlacement placement_;
  GltfAccessors accessors_;
  GltfMaterials materials_;
  GltfSkins skins_;
  const Source& source_;
  const uint64_t most_bytes_;
  LoadedFile file_;
  uint64_t bytes_ = 0;
  uint64_t primitives_ = 0;
  uint64_t vertices_ = 0;
  uint64_t triangles_ = 0;
  std::map<std::string, uint64_t> skipped_;  // what was left out, and how often
};

}  // namespace

absl::StatusOr<std::unique_ptr<GltfFile>> open_gltf(std::string bytes, const Source& source) {
  auto file = std::make_unique<GltfFile>(GltfFile{source, {}, {}, {}});
  absl::StatusOr<GltfDocument> document = parse_gltf_document(std::move(bytes), source);
  if (!document.ok()) return document.status();
  file->document = *std::move(document);
  absl::StatusOr<GltfBuffers> buffers = GltfBuffers::load(file->document, source);
  if (!buffers.ok()) return buffers.status();
  file->buffers = *std::move(buffers);
  absl::StatusOr<tinygltf::Model> model = parse_gltf_model(file->document, source);
  if (!model.ok()) return model.status();
  file->model = *std::move(model);
  return file;
}

absl::StatusOr<LoadedFile> read_gltf_model(const GltfFile& file, const tinygltf::Model& model, GltfUse use) {
  return GltfReader(model, file.document.extensions, file.buffers, file.document.looks, file.source, use).read();
}

absl::StatusOr<LoadedFile> read_gltf(std::string bytes, const Source& source) {
  const absl::StatusOr<std::unique_ptr<GltfFile>> file = open_gltf(std::move(bytes), source);
  if (!file.ok()) return file.status();
  return read_gltf_model(**file, (*file)->model, GltfUse::kMeshes);
}

}  // namespace diaphane::readers

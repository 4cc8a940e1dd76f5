#include "readers/gltf_draco.h"

#include <array>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "draco/compression/config/compression_shared.h"
#include "draco/compression/mesh/mesh_edgebreaker_decoder.h"
#include "draco/compression/mesh/mesh_sequential_decoder.h"
#include "draco/core/varint_decoding.h"
#include "draco/mesh/mesh.h"
#include "fmt/format.h"

namespace diaphane::readers {
namespace {

constexpr uint64_t kMostSeams = 8;            // attributes with a connectivity of their own
constexpr uint64_t kMostComponents = 64;      // of all attributes of a point
constexpr uint64_t kMostValues = 32'000'000;  // components times points
constexpr uint16_t kBitstream_2_2 = DRACO_BITSTREAM_VERSION(2, 2);

/// What the accessors say that the bytes hold.
struct Expected {
  uint64_t points = 0;
  uint64_t triangles = 0;
};

// Draco's decoder, stopped before it makes more than what is expected. Both kinds of connectivity begin with counts,
// and attributes say what they are before any of their values is decoded.
template <typename Decoder>
class BoundedDecoder final : public Decoder {
 public:
  explicit BoundedDecoder(const Expected& expected) : expected_(expected) {}

 private:
  bool DecodeConnectivity() override {
    return states_what_is_expected() && Decoder::DecodeConnectivity() &&
           this->mesh()->num_faces() == expected_.triangles && this->mesh()->num_points() == expected_.points;
  }

  bool DecodeAllAttributes() override {
    uint64_t components = 0;
    for (int32_t i = 0; i < this->point_cloud()->num_attributes(); ++i) {
      components += static_cast<uint64_t>(this->point_cloud()->attribute(i)->num_components());
    }
    return components <= kMostComponents && components * expected_.points <= kMostValues &&
           Decoder::DecodeAllAttributes();
  }

  bool states_what_is_expected() {
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t triangles = 0;
    uint32_t points = 0;
    if constexpr (std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>) {
      uint8_t seams = 0;
      // The first count is of vertices, of which points are parted along seams.
      return draco::DecodeVarint(&points, &ahead) && draco::DecodeVarint(&triangles, &ahead) && ahead.Decode(&seams) &&
             points <= expected_.points && triangles == expected_.triangles && seams <= kMostSeams;
    }
    return draco::DecodeVarint(&triangles, &ahead) && draco::DecodeVarint(&points, &ahead) &&
           points == expected_.points && triangles == expected_.triangles;
  }

  const Expected expected_;
};

// Appends one element of `count` values.
using Append = bool (*)(const draco::PointAttribute& attribute, draco::AttributeValueIndex index, int8_t count,
                        std::string& bytes);

template <typename T>
bool append_element(const draco::PointAttribute& attribute, draco::AttributeValueIndex index, int8_t count,
                    std::string& bytes) {
  std::array<T, 4> values{};
  if (!attribute.ConvertValue<T>(index, count, values.data())) return false;
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * static_cast<size_t>(count));
  return true;
}

Append append_of(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return append_element<int8_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return append_element<uint8_t>;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return append_element<int16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return append_element<uint16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return append_element<uint32_t>;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return append_element<float>;
    default:
      return nullptr;
  }
}

class DracoPrimitive {
 public:
  DracoPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const GltfDraco& draco,
                 std::string_view where, const Source& source)
      : model_(model), primitive_(primitive), draco_(draco), where_(where), source_(source) {}

  absl::StatusOr<GltfReplacedAccessors> decode(std::string_view compressed) {
    if (primitive_.mode != TINYGLTF_MODE_TRIANGLES) return source_.unsupported("Draco of other than triangles", where_);
    absl::Status status = find_expected();
    if (status.ok()) status = decode_mesh(compressed);
    if (status.ok()) status = replace_indices();
    for (const auto& [name, unique_id] : draco_.unique_ids) {
      if (status.ok()) status = replace_attribute(name, unique_id);
    }
    if (!status.ok()) return status;
    return std::move(replaced_);
  }

 private:
  const tinygltf::Accessor* accessor(int index) const {
    const bool exists = index >= 0 && static_cast<size_t>(index) < model_.accessors.size();
    return exists ? &model_.accessors[static_cast<size_t>(index)] : nullptr;
  }

  const tinygltf::Accessor* accessor(const std::string& attribute) const {
    const auto found = primitive_.attributes.find(attribute);
    return found == primitive_.attributes.end() ? nullptr : accessor(found->second);
  }

  absl::Status find_expected() {
    const tinygltf::Accessor* positions = accessor("POSITION");
    const tinygltf::Accessor* indices = accessor(primitive_.indices);
    if (positions == nullptr || indices == nullptr) {
      return source_.malformed("Draco compression without accessors of positions and indices", where_);
    }
    if (indices->count % 3 != 0) {
      return source_.malformed(fmt::format("{} indices", indices->count), where_, "must be a multiple of 3");
    }
    expected_ = {positions->count, indices->count / 3};
    if (expected_.points > kMostDracoPoints) {
      return source_.over_limit("vertices of a primitive in Draco", expected_.points, kMostDracoPoints);
    }
    if (expected_.triangles > kMostDracoTriangles) {
      return source_.over_limit("triangles of a primitive in Draco", expected_.triangles, kMostDracoTriangles);
    }
    return absl::OkStatus();
  }

  absl::Status decode_mesh(std::string_view compressed) {
    draco::DecoderBuffer buffer;
    buffer.Init(compressed.data(), compressed.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH) {
      return source_.malformed("is no Draco mesh", where_);
    }
    if (DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor) != kBitstream_2_2) {
      return source_.unsupported(
          fmt::format("Draco's bitstream {}.{}", int{header.version_major}, int{header.version_minor}), where_);
    }
    if (decode_bounded(header, buffer)) return absl::OkStatus();
    return source_.malformed("Draco cannot be decoded", where_,
                             fmt::format("must hold {} vertices and {} triangles as its accessors say",
                                         expected_.points, expected_.triangles));
  }

  bool decode_bounded(const draco::DracoHeader& header, draco::DecoderBuffer buffer) {
    const draco::DecoderOptions options;
    try {
      if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        return BoundedDecoder<draco::MeshEdgebreakerDecoder>(expected_).Decode(options, &buffer, &mesh_).ok();
      }
      return header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING &&
             BoundedDecoder<draco::MeshSequentialDecoder>(expected_).Decode(options, &buffer, &mesh_).ok();
    } catch (const std::length_error&) {  // a table larger than any
      return false;
    }
  }

  absl::Status replace_indices() {
    const tinygltf::Accessor& indices = *accessor(primitive_.indices);
    const auto size =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(indices.componentType)));
    std::string& bytes = replaced_[primitive_.indices];
    bytes.reserve(indices.count * size);
    for (draco::FaceIndex face(0); face < mesh_.num_faces(); ++face) {
      for (const draco::PointIndex& corner : mesh_.face(face)) {
        const uint32_t index = corner.value();
        if (index >= expected_.points || (size < 4 && index >> (8 * size) != 0)) {
          return source_.malformed(fmt::format("index {} in Draco", index), where_,
                                   fmt::format("there are {} vertices", expected_.points));
        }
        // Little-endian, as the machine.
        bytes.append(reinterpret_cast<const char*>(&index), size);
      }
    }
    return absl::OkStatus();
  }

  absl::Status replace_attribute(const std::string& name, uint32_t unique_id) {
    const tinygltf::Accessor* accessor = this->accessor(name);
    const draco::PointAttribute* attribute = mesh_.GetAttributeByUniqueId(unique_id);
    if (accessor == nullptr || attribute == nullptr) {
      return source_.malformed(fmt::format("attribute {} has no accessor or no data in Draco", in_quotes(name)),
                               where_);
    }
    const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor->type));
    const Append append = append_of(accessor->componentType);
    if (append == nullptr || components > 4 || components != attribute->num_components() ||
        accessor->count != expected_.points) {
      return source_.malformed(fmt::format("attribute {} is another in Draco", in_quotes(name)), where_,
                               "type and count must be its accessor's");
    }
    std::string& bytes = replaced_[primitive_.attributes.at(name)];
    bytes.clear();
    for (draco::PointIndex point(0); point < mesh_.num_points(); ++point) {
      const bool is_mapped = attribute->is_mapping_identity() || point.value() < attribute->indices_map_size();
      const draco::AttributeValueIndex index =
          is_mapped ? attribute->mapped_index(point) : draco::kInvalidAttributeValueIndex;
      if (index.value() >= attribute->size() || !append(*attribute, index, static_cast<int8_t>(components), bytes)) {
        return source_.malformed(fmt::format("attribute {} of vertex {} in Draco", in_quotes(name), point.value()),
                                 where_, "must be a number of its accessor's type");
      }
    }
    return absl::OkStatus();
  }

  const tinygltf::Model& model_;
  const tinygltf::Primitive& primitive_;
  const GltfDraco& draco_;
  const std::string_view where_;
  const Source& source_;
  Expected expected_;
  draco::Mesh mesh_;
  GltfReplacedAccessors replaced_;
};

}  // namespace

absl::StatusOr<GltfReplacedAccessors> decode_draco(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const GltfDraco& draco, std::string_view compressed,
                                                   std::string_view where, const Source& source) {
  return DracoPrimitive(model, primitive, draco, where, source).decode(compressed);
}

}  // namespace diaphane::readers

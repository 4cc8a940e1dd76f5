// Numbers out of glTF accessors, with every reference and range checked first.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/values.h"
#include "readers/gltf_buffers.h"
#include "readers/gltf_extensions.h"
#include "readers/gltf_meshopt.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

using GltfFloat4 = std::array<float, 4>;

/// Bytes that stand in the place of an accessor's own, its elements one behind the other, as many as it counts.
using GltfReplacedAccessors = std::map<int, std::string>;

/// Reads accessors of one model. Not thread-safe. What it is made from outlives it.
///
/// A file can name one accessor again and again, so that its size does not bound the work: all that is read together is
/// bounded, by a multiple of the limits.
class GltfAccessors {
 public:
  GltfAccessors(const tinygltf::Model& model, const GltfExtensions& extensions, const GltfBuffers& buffers,
                const Source& source);

  /// Takes other bytes for some accessors, until the next call.
  void replace(GltfReplacedAccessors replaced) { replaced_ = std::move(replaced); }

  /// The bytes of a buffer view. kInvalidArgument where it is none or reaches out of its buffer.
  absl::StatusOr<std::string_view> view_bytes(int view, std::string_view where);

  /// Elements of `accessor`. kInvalidArgument where there is no such accessor.
  absl::StatusOr<uint64_t> count(int accessor) const;

  /// Counts `elements` against the bound on all that is read.
  absl::Status spend(uint64_t elements, std::string_view where);

  /// `count` VEC3 of floats, or of 8 or 16 bit integers, normalised or not (KHR_mesh_quantization). Where
  /// `may_be_absent`, an accessor without data is zeros, as in morph targets.
  absl::StatusOr<std::vector<Vec3>> read_vec3(int accessor, uint64_t count, bool may_be_absent = false);

  /// `count` VEC3 or VEC4 of floats or of normalised unsigned integers: linear colours, whose alpha is passed over.
  absl::StatusOr<std::vector<Rgb>> read_colours(int accessor, uint64_t count);

  /// `count` VEC2 of what read_vec3() takes.
  absl::StatusOr<std::vector<TextureCoordinate>> read_texture_coordinates(int accessor, uint64_t count);

  /// `count` VEC4 of unsigned 8 or 16 bit integers: JOINTS_n.
  absl::StatusOr<std::vector<GltfFloat4>> read_joints(int accessor, uint64_t count);

  /// `count` VEC4 of floats or of normalised unsigned integers: WEIGHTS_n.
  absl::StatusOr<std::vector<GltfFloat4>> read_weights(int accessor, uint64_t count);

  /// `count` MAT4 of floats, column-major.
  absl::StatusOr<std::vector<std::array<float, 16>>> read_matrices(int accessor, uint64_t count);

  /// `count` VEC3 of floats: translations and scales of EXT_mesh_gpu_instancing.
  absl::StatusOr<std::vector<Vec3>> read_offsets(int accessor, uint64_t count);

  /// `count` VEC4 of floats or of normalised signed integers: its rotations.
  absl::StatusOr<std::vector<GltfFloat4>> read_quaternions(int accessor, uint64_t count);

  /// `count` SCALAR of floats or of normalised integers: keys of animations, and morph weights.
  absl::StatusOr<std::vector<float>> read_scalars(int accessor, uint64_t count);

  /// `count` SCALAR of unsigned integers.
  absl::StatusOr<std::vector<uint32_t>> read_indices(int accessor, uint64_t count);

 private:
  // Elements `stride` bytes apart, known to lie inside a buffer.
  struct Elements {
    const char* data = nullptr;
    size_t stride = 0;
    const char* operator[](size_t i) const { return data + i * stride; }
  };

  struct AttributeForm;

  absl::StatusOr<const tinygltf::Accessor*> find(int accessor) const;
  absl::StatusOr<Elements> locate(int view, uint64_t offset, uint64_t element_bytes, uint64_t count,
                                  std::string_view where);
  absl::StatusOr<Elements> locate_accessor(int index, const tinygltf::Accessor& accessor, std::string_view where);
  absl::StatusOr<const tinygltf::Accessor*> find_attribute(int accessor, uint64_t count, const AttributeForm& form,
                                                           std::string_view where);
  bool has_data(int index, const tinygltf::Accessor& accessor) const {
    return accessor.bufferView >= 0 || replaced_.contains(index);
  }
  absl::Status check_count(const tinygltf::Accessor& accessor, uint64_t count, std::string_view where) const;
  template <typename T>
  absl::StatusOr<std::vector<T>> read(int accessor, uint64_t count, const AttributeForm& form);
  template <typename T>
  absl::Status apply_sparse(const tinygltf::Accessor& accessor, std::string_view where, std::vector<T>& values);

  const tinygltf::Model& model_;
  const GltfBuffers& buffers_;
  const Source& source_;
  GltfMeshoptViews meshopt_views_;
  GltfReplacedAccessors replaced_;
  const uint64_t most_elements_;
  uint64_t elements_ = 0;
};

}  // namespace diaphane::readers

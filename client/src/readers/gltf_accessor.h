// Numbers out of glTF accessors, with every reference and range checked first.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/values.h"
#include "readers/gltf_buffers.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// Reads accessors of one model. Not thread-safe. `model`, `buffers` and `source` outlive it.
///
/// A file can name one accessor again and again, so that its size does not bound the work: all that is read together is
/// bounded, by a multiple of the limits.
class GltfAccessors {
 public:
  GltfAccessors(const tinygltf::Model& model, const GltfBuffers& buffers, const Source& source);

  /// Elements of `accessor`. kInvalidArgument where there is no such accessor.
  absl::StatusOr<uint64_t> count(int accessor) const;

  /// `count` VEC3 of floats, or of 8 or 16 bit integers, normalised or not (KHR_mesh_quantization). Where
  /// `may_be_absent`, an accessor without data is zeros, as in morph targets.
  absl::StatusOr<std::vector<Vec3>> read_vec3(int accessor, uint64_t count, bool may_be_absent = false);

  /// `count` VEC3 or VEC4 of floats or of normalised unsigned integers: linear colours, whose alpha is passed over.
  absl::StatusOr<std::vector<Rgb>> read_colours(int accessor, uint64_t count);

  /// `count` VEC2 of what read_vec3() takes.
  absl::StatusOr<std::vector<TextureCoordinate>> read_texture_coordinates(int accessor, uint64_t count);

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
                                  std::string_view where) const;
  absl::Status spend(uint64_t elements, uint64_t expected, std::string_view where);
  absl::StatusOr<const tinygltf::Accessor*> find_attribute(int accessor, uint64_t count, const AttributeForm& form,
                                                           std::string_view where);
  template <typename T>
  absl::StatusOr<std::vector<T>> read(int accessor, uint64_t count, const AttributeForm& form);
  template <typename T>
  absl::Status apply_sparse(const tinygltf::Accessor& accessor, std::string_view where, std::vector<T>& values);

  const tinygltf::Model& model_;
  const GltfBuffers& buffers_;
  const Source& source_;
  const uint64_t most_elements_;
  uint64_t elements_ = 0;
};

}  // namespace diaphane::readers

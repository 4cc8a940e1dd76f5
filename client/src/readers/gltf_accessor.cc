#include "readers/gltf_accessor.h"

#include "fmt/format.h"
#include "readers/gltf_component.h"

namespace diaphane::readers {

GltfAccessors::GltfAccessors(const tinygltf::Model& model, const GltfExtensions& extensions, const GltfBuffers& buffers,
                             const Source& source)
    : model_(model),
      buffers_(buffers),
      source_(source),
      meshopt_views_(extensions, buffers, source),
      most_elements_(6 * source.limits.max_vertices + 3 * source.limits.max_triangles) {}

absl::StatusOr<const tinygltf::Accessor*> GltfAccessors::find(int accessor) const {
  if (accessor < 0 || static_cast<size_t>(accessor) >= model_.accessors.size()) {
    return source_.malformed(fmt::format("accessor {}", accessor), "",
                             fmt::format("there are {}", model_.accessors.size()));
  }
  return &model_.accessors[static_cast<size_t>(accessor)];
}

absl::StatusOr<uint64_t> GltfAccessors::count(int accessor) const {
  const absl::StatusOr<const tinygltf::Accessor*> found = find(accessor);
  if (!found.ok()) return found.status();
  return (*found)->count;
}

absl::Status GltfAccessors::check_count(const tinygltf::Accessor& accessor, uint64_t count,
                                        std::string_view where) const {
  if (accessor.count == count) return absl::OkStatus();
  return source_.malformed(fmt::format("{} elements", accessor.count), where, fmt::format("must be {}", count));
}

absl::Status GltfAccessors::spend(uint64_t elements, std::string_view where) {
  if (elements > most_elements_ - elements_) {
    return source_.error(absl::StatusCode::kResourceExhausted, "too many accessor elements", where,
                         fmt::format("must be at most {} in all", most_elements_));
  }
  elements_ += elements;
  return absl::OkStatus();
}

absl::StatusOr<std::string_view> GltfAccessors::view_bytes(int view, std::string_view where) {
  if (view < 0 || static_cast<size_t>(view) >= model_.bufferViews.size()) {
    return source_.malformed(fmt::format("bufferView {}", view), where,
                             fmt::format("there are {}", model_.bufferViews.size()));
  }
  const tinygltf::BufferView& v = model_.bufferViews[static_cast<size_t>(view)];
  if (meshopt_views_.has(static_cast<size_t>(view))) {
    const absl::StatusOr<std::string_view> decoded = meshopt_views_.decode(static_cast<size_t>(view));
    if (decoded.ok() && decoded->size() != v.byteLength) {
      return source_.malformed(fmt::format("byteLength {} of bufferView {}", v.byteLength, view), where,
                               fmt::format("{} bytes were compressed", decoded->size()));
    }
    return decoded;
  }
  if (v.buffer < 0 || static_cast<size_t>(v.buffer) >= buffers_.size()) {
    return source_.malformed(fmt::format("buffer {} of bufferView {}", v.buffer, view), where,
                             fmt::format("there are {}", buffers_.size()));
  }
  const std::string_view bytes = buffers_[static_cast<size_t>(v.buffer)];
  if (v.byteOffset > bytes.size() || v.byteLength > bytes.size() - v.byteOffset) {
    return source_.malformed(fmt::format("bytes {} + {} of bufferView {}", v.byteOffset, v.byteLength, view), where,
                             fmt::format("the buffer has {}", bytes.size()));
  }
  return bytes.substr(v.byteOffset, v.byteLength);
}

absl::StatusOr<GltfAccessors::Elements> GltfAccessors::locate(int view, uint64_t offset, uint64_t element_bytes,
                                                              uint64_t count, std::string_view where) {
  const absl::StatusOr<std::string_view> bytes = view_bytes(view, where);
  if (!bytes.ok()) return bytes.status();
  const size_t byte_stride = model_.bufferViews[static_cast<size_t>(view)].byteStride;
  const uint64_t stride = byte_stride == 0 ? element_bytes : byte_stride;
  if (stride < element_bytes) {
    return source_.malformed(fmt::format("byteStride {} of bufferView {}", stride, view), where,
                             fmt::format("must be at least {}", element_bytes));
  }
  // In this order nothing can overflow: what is multiplied later has been divided here.
  const uint64_t room = offset > bytes->size() ? 0 : bytes->size() - offset;
  if (count > 0 && (room < element_bytes || count - 1 > (room - element_bytes) / stride)) {
    return source_.malformed(fmt::format("{} elements of {} bytes, {} apart", count, element_bytes, stride), where,
                             fmt::format("bufferView {} has {} bytes for them", view, room));
  }
  return Elements{count > 0 ? bytes->data() + offset : nullptr, stride};
}

absl::StatusOr<GltfAccessors::Elements> GltfAccessors::locate_accessor(int index, const tinygltf::Accessor& accessor,
                                                                       std::string_view where) {
  const size_t size = element_bytes(accessor);
  if (const auto replaced = replaced_.find(index); replaced != replaced_.end()) {
    return Elements{replaced->second.data(), size};
  }
  return locate(accessor.bufferView, accessor.byteOffset, size, accessor.count, where);
}

struct GltfAccessors::AttributeForm {
  std::array<int, 2> types;
  bool (*takes)(const tinygltf::Accessor& accessor);  // component types
  std::string_view range;
  bool may_be_absent = false;
};

absl::StatusOr<std::vector<Vec3>> GltfAccessors::read_vec3(int accessor, uint64_t count, bool may_be_absent) {
  return read<Vec3>(accessor, count,
                    {{TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3},
                     is_any_type,
                     "must be VEC3 of floats or of 8 or 16 bit integers",
                     may_be_absent});
}

absl::StatusOr<std::vector<Rgb>> GltfAccessors::read_colours(int accessor, uint64_t count) {
  return read<Rgb>(accessor, count,
                   {{TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4},
                    is_unit_type,
                    "must be VEC3 or VEC4 of floats or of normalised unsigned 8 or 16 bit integers"});
}

absl::StatusOr<std::vector<TextureCoordinate>> GltfAccessors::read_texture_coordinates(int accessor, uint64_t count) {
  return read<TextureCoordinate>(
      accessor, count,
      {{TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC2}, is_any_type, "must be VEC2 of floats or of 8 or 16 bit integers"});
}

absl::StatusOr<std::vector<GltfFloat4>> GltfAccessors::read_joints(int accessor, uint64_t count) {
  return read<GltfFloat4>(
      accessor, count,
      {{TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4}, is_joint_type, "must be VEC4 of unsigned 8 or 16 bit integers"});
}

absl::StatusOr<std::vector<GltfFloat4>> GltfAccessors::read_weights(int accessor, uint64_t count) {
  return read<GltfFloat4>(accessor, count,
                          {{TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4},
                           is_unit_type,
                           "must be VEC4 of floats or of normalised unsigned 8 or 16 bit integers"});
}

absl::StatusOr<std::vector<std::array<float, 16>>> GltfAccessors::read_matrices(int accessor, uint64_t count) {
  return read<std::array<float, 16>>(
      accessor, count, {{TINYGLTF_TYPE_MAT4, TINYGLTF_TYPE_MAT4}, is_float_type, "must be MAT4 of floats"});
}

absl::StatusOr<std::vector<Vec3>> GltfAccessors::read_offsets(int accessor, uint64_t count) {
  return read<Vec3>(accessor, count,
                    {{TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, is_float_type, "must be VEC3 of floats"});
}

absl::StatusOr<std::vector<GltfFloat4>> GltfAccessors::read_quaternions(int accessor, uint64_t count) {
  return read<GltfFloat4>(accessor, count,
                          {{TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4},
                           is_rotation_type,
                           "must be VEC4 of floats or of normalised 8 or 16 bit integers"});
}

absl::StatusOr<std::vector<float>> GltfAccessors::read_scalars(int accessor, uint64_t count) {
  return read<float>(accessor, count,
                     {{TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_SCALAR},
                      [](const tinygltf::Accessor& a) { return is_unit_type(a) || is_rotation_type(a); },
                      "must be SCALAR of floats or of normalised 8 or 16 bit integers"});
}

absl::StatusOr<const tinygltf::Accessor*> GltfAccessors::find_attribute(int index, uint64_t count,
                                                                        const AttributeForm& form,
                                                                        std::string_view where) {
  const absl::StatusOr<const tinygltf::Accessor*> found = find(index);
  if (!found.ok()) return found.status();
  const tinygltf::Accessor& accessor = **found;
  if ((accessor.type != form.types[0] && accessor.type != form.types[1]) || !form.takes(accessor)) {
    return source_.malformed(fmt::format("type {} of component type {}", accessor.type, accessor.componentType), where,
                             form.range);
  }
  absl::Status status = check_count(accessor, count, where);
  if (status.ok()) status = spend(count, where);
  if (!status.ok()) return status;
  if (!has_data(index, accessor) && !accessor.sparse.isSparse && !form.may_be_absent) {
    return source_.malformed("no data", where, "must have a bufferView or be sparse");
  }
  return &accessor;
}

template <typename T>
absl::StatusOr<std::vector<T>> GltfAccessors::read(int index, uint64_t count, const AttributeForm& form) {
  const std::string where = fmt::format("accessor {}", index);
  const absl::StatusOr<const tinygltf::Accessor*> found = find_attribute(index, count, form, where);
  if (!found.ok()) return found.status();
  const tinygltf::Accessor& accessor = **found;
  std::vector<T> values;
  if (has_data(index, accessor)) {
    const absl::StatusOr<Elements> elements = locate_accessor(index, accessor, where);
    if (!elements.ok()) return elements.status();
    values.resize(count);
    for (size_t i = 0; i < values.size(); ++i) values[i] = load_floats<T>((*elements)[i], accessor);
  } else {
    values.resize(count);
  }
  if (accessor.sparse.isSparse) {
    const absl::Status applied = apply_sparse(accessor, where, values);
    if (!applied.ok()) return applied;
  }
  return values;
}

template <typename T>
absl::Status GltfAccessors::apply_sparse(const tinygltf::Accessor& accessor, std::string_view where,
                                         std::vector<T>& values) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 1 || static_cast<uint64_t>(sparse.count) > values.size()) {
    return source_.malformed(fmt::format("sparse count {}", sparse.count), where,
                             fmt::format("must be 1..{}", values.size()));
  }
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 || !is_index_type(sparse.indices.componentType)) {
    return source_.malformed("sparse offsets or index type", where, "must be 0 or more, and unsigned");
  }
  const auto count = static_cast<uint64_t>(sparse.count);
  const absl::Status status = spend(count, where);
  if (!status.ok()) return status;
  const absl::StatusOr<Elements> indices =
      locate(sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset),
             component_bytes(sparse.indices.componentType), count, where);
  if (!indices.ok()) return indices.status();
  const absl::StatusOr<Elements> replaced = locate(
      sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), element_bytes(accessor), count, where);
  if (!replaced.ok()) return replaced.status();
  for (size_t i = 0; i < count; ++i) {
    const uint32_t target = load_index((*indices)[i], sparse.indices.componentType);
    if (target >= values.size()) {
      return source_.malformed(fmt::format("sparse index {}", target), where,
                               fmt::format("must be 0..{}", values.size() - 1));
    }
    values[target] = load_floats<T>((*replaced)[i], accessor);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<uint32_t>> GltfAccessors::read_indices(int index, uint64_t count) {
  const absl::StatusOr<const tinygltf::Accessor*> found = find(index);
  if (!found.ok()) return found.status();
  const tinygltf::Accessor& accessor = **found;
  const std::string where = fmt::format("accessor {}", index);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType) || accessor.normalized) {
    return source_.malformed(fmt::format("type {} of component type {}", accessor.type, accessor.componentType), where,
                             "indices must be SCALAR of unsigned integers");
  }
  if (accessor.sparse.isSparse) return source_.unsupported("a sparse accessor of indices", where);
  absl::Status status = check_count(accessor, count, where);
  if (status.ok()) status = spend(count, where);
  if (!status.ok()) return status;
  const absl::StatusOr<Elements> elements = locate_accessor(index, accessor, where);
  if (!elements.ok()) return elements.status();
  std::vector<uint32_t> indices(count);
  for (size_t i = 0; i < indices.size(); ++i) indices[i] = load_index((*elements)[i], accessor.componentType);
  return indices;
}

}  // namespace diaphane::readers

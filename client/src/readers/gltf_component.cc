#include "readers/gltf_component.h"

#include <algorithm>
#include <cstring>

namespace diaphane::readers {
namespace {

// glTF is little-endian, and so is every machine that this is built for.
template <typename T>
T load(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

}  // namespace

float load_component(const char* data, int component, bool normalized) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<int8_t>(data);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = load<uint8_t>(data);
      return normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<int16_t>(data);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<uint16_t>(data);
      return normalized ? value / 65535.0f : value;
    }
    default:
      return load<float>(data);
  }
}

size_t component_bytes(int component) {
  return static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component)));
}

size_t element_bytes(const tinygltf::Accessor& accessor) {
  return component_bytes(accessor.componentType) *
         static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
}

uint32_t load_index(const char* data, int component) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<uint8_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(data);
    default:
      return load<uint32_t>(data);
  }
}

bool is_index_type(int component) {
  return component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool is_any_type(const tinygltf::Accessor& accessor) {
  const int component = accessor.componentType;
  return component == TINYGLTF_COMPONENT_TYPE_FLOAT ||
         (component >= TINYGLTF_COMPONENT_TYPE_BYTE && component <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool is_unit_type(const tinygltf::Accessor& accessor) {
  const int component = accessor.componentType;
  return component == TINYGLTF_COMPONENT_TYPE_FLOAT ||
         (accessor.normalized &&
          (component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT));
}

bool is_float_type(const tinygltf::Accessor& accessor) {
  return accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

bool is_joint_type(const tinygltf::Accessor& accessor) {
  return !accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                  accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool is_rotation_type(const tinygltf::Accessor& accessor) {
  return is_float_type(accessor) || (accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE ||
                                                             accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT));
}

}  // namespace diaphane::readers

// Components and elements of glTF accessors: their types, and their bytes as numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "tiny_gltf.h"

namespace diaphane::readers {

/// One component as glTF 2.0 section 3.11 and KHR_mesh_quantization map it.
float load_component(const char* data, int component, bool normalized);

/// Of a type that is_index_type() takes.
uint32_t load_index(const char* data, int component);

size_t component_bytes(int component);
size_t element_bytes(const tinygltf::Accessor& accessor);

/// The leading components of an element, as many floats as T is made of.
template <typename T>
T load_floats(const char* data, const tinygltf::Accessor& accessor) {
  constexpr size_t kCount = sizeof(T) / sizeof(float);
  std::array<float, kCount> values;
  const size_t step = component_bytes(accessor.componentType);
  for (size_t i = 0; i < kCount; ++i) {
    values[i] = load_component(data + i * step, accessor.componentType, accessor.normalized);
  }
  return std::bit_cast<T>(values);
}

bool is_index_type(int component);

/// Floats, or 8 or 16 bit integers.
bool is_any_type(const tinygltf::Accessor& accessor);
/// Floats, or normalised unsigned 8 or 16 bit integers.
bool is_unit_type(const tinygltf::Accessor& accessor);
bool is_float_type(const tinygltf::Accessor& accessor);
/// Unsigned 8 or 16 bit integers that are not normalised.
bool is_joint_type(const tinygltf::Accessor& accessor);
/// Floats, or normalised signed 8 or 16 bit integers.
bool is_rotation_type(const tinygltf::Accessor& accessor);

}  // namespace diaphane::readers

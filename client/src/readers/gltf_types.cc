#include "readers/gltf_types.h"

#include <algorithm>
#include <string_view>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

using nlohmann::json;

constexpr std::string_view kLists[] = {"accessors", "buffers", "bufferViews", "meshes", "nodes", "scenes", "skins"};
constexpr std::string_view kIntegers[] = {
    "buffer",  "bufferView", "byteLength", "byteOffset", "byteStride", "componentType",      "count",
    "indices", "mesh",       "mode",       "scene",      "skin",       "inverseBindMatrices"};
constexpr std::string_view kIntegerArrays[] = {"children", "joints", "nodes"};
constexpr std::string_view kNumberArrays[] = {"matrix", "rotation", "scale", "translation", "weights"};
constexpr std::string_view kObjectArrays[] = {"primitives", "targets"};

template <size_t size>
bool contains(const std::string_view (&names)[size], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

template <typename Predicate>
bool is_array_of(const json& value, Predicate predicate) {
  return value.is_array() && std::all_of(value.begin(), value.end(), predicate);
}

// What the member `key` must be and is not, or nothing. In maps of attributes every member is an index.
std::string_view expected_instead(std::string_view key, const json& value, bool attributes) {
  const auto is_integer = [](const json& v) { return v.is_number_integer(); };
  const auto is_number = [](const json& v) { return v.is_number(); };
  const auto is_object = [](const json& v) { return v.is_object(); };
  // A sparse accessor's "indices" is an object, a primitive's is an index.
  const bool integer = attributes || (contains(kIntegers, key) && !(key == "indices" && value.is_object()));
  if (integer && !is_integer(value)) return "must be an integer of 32 bits";
  if (contains(kIntegerArrays, key) && !is_array_of(value, is_integer)) return "must be an array of integers";
  if (contains(kNumberArrays, key) && !is_array_of(value, is_number)) return "must be an array of numbers";
  if (contains(kObjectArrays, key) && !is_array_of(value, is_object)) return "must be an array of objects";
  if (key == "attributes" && !value.is_object()) return "must be an object";
  if (key == "normalized" && !value.is_boolean()) return "must be a boolean";
  return {};
}

// The nesting that is left in a document is bounded, and so is this recursion.
absl::Status check_members(const json& object, bool attributes, std::string_view where, const Source& source) {
  for (const auto& [key, value] : object.items()) {
    const std::string_view expected = expected_instead(key, value, attributes);
    if (!expected.empty()) return source.malformed(fmt::format("{} of the wrong type", key), where, expected);
    if (value.is_object()) {
      const absl::Status status = check_members(value, key == "attributes", where, source);
      if (!status.ok()) return status;
    } else if (contains(kObjectArrays, key)) {
      for (const json& element : value) {
        const absl::Status status = check_members(element, key == "targets", where, source);
        if (!status.ok()) return status;
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_gltf_types(const json& root, const Source& source) {
  const auto scene = root.find("scene");
  if (scene != root.end() && !scene->is_number_integer()) {
    return source.malformed("scene of the wrong type", "in the JSON", "must be an integer of 32 bits");
  }
  for (std::string_view list : kLists) {
    const auto elements = root.find(std::string(list));
    if (elements == root.end()) continue;
    for (size_t i = 0; i < elements->size(); ++i) {
      const json& element = (*elements)[i];
      const std::string where = fmt::format("{} {}", list, i);
      if (!element.is_object()) return source.malformed("an element is no object", where);
      const absl::Status status = check_members(element, false, where, source);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

}  // namespace diaphane::readers

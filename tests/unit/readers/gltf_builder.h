// glTF scenes for the tests.
#pragma once

#include <string>
#include <vector>

#include "nlohmann/json.hpp"
#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kFloat = 5126;

// A scene under construction; starts as one triangle: accessor 0 its positions, 1 its indices 0 1 2.
class Gltf {
 public:
  Gltf() {
    json_ = {{"asset", {{"version", "2.0"}}},
             {"nodes", {{{"mesh", 0}}}},
             {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}}};
    add_accessor(positions({0, 0, 0, 1, 0, 0, 0, 1, 0}), kFloat, "VEC3", 3);
    add_accessor(raw(uint16_t{0}) + raw(uint16_t{1}) + raw(uint16_t{2}), kUnsignedShort, "SCALAR", 3);
  }

  static std::string positions(const std::vector<float>& values) {
    std::string bytes;
    for (float value : values) bytes += raw(value);
    return bytes;
  }

  void patch(const char* pointer, nlohmann::json value) {
    json_[nlohmann::json::json_pointer(pointer)] = std::move(value);
  }
  nlohmann::json& operator[](const char* key) { return json_[key]; }
  nlohmann::json& primitive() { return json_["meshes"][0]["primitives"][0]; }
  nlohmann::json& accessor(size_t i) { return json_["accessors"][i]; }

  int add_view(const std::string& bytes) {
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
    binary_ += bytes;
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }

  int add_accessor(const std::string& bytes, int component, const char* type, size_t count, bool normalized = false) {
    nlohmann::json accessor = {
        {"bufferView", add_view(bytes)}, {"componentType", component}, {"type", type}, {"count", count}};
    if (normalized) accessor["normalized"] = true;
    json_["accessors"].push_back(std::move(accessor));
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  std::string& binary() { return binary_; }

  std::string as_glb() {
    if (!json_.contains("buffers")) json_["buffers"] = {{{"byteLength", binary_.size()}}};
    return glb(json_.dump(), binary_);
  }

  absl::StatusOr<LoadedFile> read(const ReadLimits& limits = {}) { return read_bytes("scene.glb", as_glb(), limits); }

 private:
  nlohmann::json json_;
  std::string binary_;
};

}  // namespace diaphane::testing

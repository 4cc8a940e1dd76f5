// The one place where tinygltf is compiled. Without its file access (TINYGLTF_NO_FS) it forgets this header.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "fmt/format.h"
#include "readers/gltf_model.h"

namespace diaphane::readers {
namespace {

std::string first_line(const std::string& text) {
  const size_t begin = text.find_first_not_of('\n');
  if (begin == std::string::npos) return {};
  return text.substr(begin, std::min<size_t>(text.find('\n', begin) - begin, 160));
}

// tinygltf asks for what glTF 2.0 leaves open; -1 stands for none.
void give_skins_matrices(nlohmann::json& root) {
  const auto skins = root.find("skins");
  if (skins == root.end()) return;
  for (nlohmann::json& skin : *skins) skin.emplace("inverseBindMatrices", -1);
}

// It also wants bytes behind every index; what Draco compressed has none.
void put_back_indices(const GltfExtensions& extensions, tinygltf::Model& model) {
  for (const auto& [place, draco] : extensions.draco_of_primitive) {
    const auto& [mesh, primitive] = place;
    if (mesh < model.meshes.size() && primitive < model.meshes[mesh].primitives.size()) {
      model.meshes[mesh].primitives[primitive].indices = draco.indices;
    }
  }
}

}  // namespace

absl::StatusOr<tinygltf::Model> parse_gltf_model(GltfDocument& document, const Source& source) {
  document.json.erase("buffers");
  give_skins_matrices(document.json);
  const std::string text = document.json.dump();
  document.json = nullptr;

  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string errors, warnings;
  bool parsed = false;
  // tinygltf reads JSON of the wrong type with calls that throw.
  try {
    parsed =
        loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned int>(text.size()), "");
  } catch (const nlohmann::json::exception& error) {
    errors = error.what();
  }
  // It also goes on without what it found wrong; half a scene is not what was asked for.
  if (!parsed || !errors.empty()) return source.malformed(fmt::format("is not glTF 2.0: {}", first_line(errors)));
  put_back_indices(document.extensions, model);
  return model;
}

}  // namespace diaphane::readers

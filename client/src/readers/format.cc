#include "readers/format.h"

#include <utility>

#include "readers/off.h"
#include "readers/stl.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";

bool starts_with(std::string_view bytes, std::string_view prefix) { return bytes.substr(0, prefix.size()) == prefix; }

bool looks_like_json_object(std::string_view bytes) {
  if (starts_with(bytes, kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{';
}

}  // namespace

std::optional<MeshFormat> tell_format(std::string_view bytes, std::string_view extension) {
  if (starts_with(bytes, "glTF")) return MeshFormat::kGltf;
  if (starts_with(bytes, "ply\n") || starts_with(bytes, "ply\r")) return MeshFormat::kPly;
  if (is_binary_stl(bytes) || looks_like_ascii_stl(bytes)) return MeshFormat::kStl;
  if (looks_like_off(bytes)) return MeshFormat::kOff;
  if (looks_like_json_object(bytes)) return MeshFormat::kGltf;

  static constexpr std::pair<std::string_view, MeshFormat> kExtensions[] = {
      {".gltf", MeshFormat::kGltf}, {".glb", MeshFormat::kGltf}, {".obj", MeshFormat::kObj},
      {".off", MeshFormat::kOff},   {".ply", MeshFormat::kPly},  {".stl", MeshFormat::kStl}};
  for (const auto& [name, format] : kExtensions) {
    if (equals_ignoring_case(extension, name)) return format;
  }
  return std::nullopt;
}

}  // namespace diaphane::readers

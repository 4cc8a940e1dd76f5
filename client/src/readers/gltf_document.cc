#include "readers/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

#include "fmt/format.h"
#include "readers/gltf_animation.h"
#include "readers/gltf_json.h"
#include "readers/gltf_materials.h"
#include "readers/gltf_types.h"

namespace diaphane::readers {
namespace {

using nlohmann::json;

constexpr size_t kMostJsonBytes = size_t{256} << 20;

constexpr size_t kGlbHeaderBytes = 12;
constexpr size_t kGlbChunkHeaderBytes = 8;
constexpr uint32_t kGlbJson = 0x4e4f534a;
constexpr uint32_t kGlbBinary = 0x004e4942;

constexpr std::string_view kArrays[] = {"accessors", "buffers",        "bufferViews",       "meshes", "nodes", "scenes",
                                        "skins",     "extensionsUsed", "extensionsRequired"};

// Required extensions that change nothing of what is read here.
constexpr std::string_view kHarmlessPrefixes[] = {"KHR_materials_", "KHR_texture_",  "KHR_lights_", "KHR_animation_",
                                                  "EXT_texture_",   "MSFT_texture_", "KHR_xmp"};

uint32_t read_u32(std::string_view bytes, size_t offset) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes.data() + offset, b.size());
  return uint32_t{b[0]} | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

// Finds the chunks of document.bytes; `text` becomes the JSON one.
absl::Status split_glb(GltfDocument& document, std::string_view& text, const Source& source) {
  const std::string_view bytes = document.bytes;
  text = {};
  if (bytes.size() < kGlbHeaderBytes)
    return source.malformed("ends within the GLB header", Place{"byte", bytes.size()});
  const uint32_t version = read_u32(bytes, 4);
  if (version == 1) return source.unsupported("glTF 1");
  if (version != 2) return source.malformed(fmt::format("GLB version {}", version), Place{"byte", 4}, "must be 2");
  const size_t length = read_u32(bytes, 8);
  if (length > bytes.size() || length < kGlbHeaderBytes) {
    return source.malformed(fmt::format("GLB length {}", length), Place{"byte", 8},
                            fmt::format("must be {}..{}", kGlbHeaderBytes, bytes.size()));
  }
  size_t offset = kGlbHeaderBytes;
  for (int chunk = 0; offset < length; ++chunk) {
    if (length - offset < kGlbChunkHeaderBytes) {
      return source.malformed("ends within a GLB chunk header", Place{"byte", offset});
    }
    const size_t size = read_u32(bytes, offset);
    const uint32_t type = read_u32(bytes, offset + 4);
    const size_t room = length - offset - kGlbChunkHeaderBytes;
    if (size > room) {
      return source.malformed(fmt::format("GLB chunk of {} bytes", size), Place{"byte", offset},
                              fmt::format("there is room for {}", room));
    }
    if ((chunk == 0) != (type == kGlbJson)) {
      return source.malformed("the first GLB chunk, and no other, must be JSON", Place{"byte", offset});
    }
    if (chunk == 0) {
      text = bytes.substr(offset + kGlbChunkHeaderBytes, size);
    } else if (type == kGlbBinary) {
      if (document.has_chunk) return source.malformed("a second binary chunk", Place{"byte", offset});
      document.has_chunk = true;
      document.chunk_offset = offset + kGlbChunkHeaderBytes;
      document.chunk_size = size;
    }
    offset += kGlbChunkHeaderBytes + size;
  }
  return text.empty() ? source.malformed("has no JSON chunk") : absl::OkStatus();
}

absl::Status check_version(const json& root, const Source& source) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string()) {
    return source.malformed("asset.version is missing", "in the JSON", "must be \"2.0\"");
  }
  for (const char* name : {"version", "minVersion"}) {
    const auto entry = asset->find(name);
    if (entry == asset->end()) continue;
    const std::string version = entry->is_string() ? entry->get<std::string>() : std::string();
    if (version.rfind("1.", 0) == 0) return source.unsupported("glTF 1");
    if (version.rfind("2.", 0) != 0 || (version != "2.0" && name == std::string_view("minVersion"))) {
      return source.malformed(fmt::format("asset.{} {}", name, in_quotes(version)), "in the JSON", "must be \"2.0\"");
    }
  }
  return absl::OkStatus();
}

absl::Status check_extensions(const json& root, const Source& source) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end()) return absl::OkStatus();
  for (const json& entry : *required) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : std::string();
    const bool harmless = std::any_of(std::begin(kHarmlessPrefixes), std::end(kHarmlessPrefixes),
                                      [&name](std::string_view prefix) { return name.rfind(prefix, 0) == 0; });
    const bool is_read =
        std::find(std::begin(kReadExtensions), std::end(kReadExtensions), name) != std::end(kReadExtensions);
    if (!harmless && !is_read && name != "KHR_mesh_quantization") {
      return source.unsupported(fmt::format("required extension {}", in_quotes(name)));
    }
  }
  return absl::OkStatus();
}

absl::Status parse_json(std::string_view text, GltfDocument& document, const Source& source) {
  if (text.size() > kMostJsonBytes) return source.over_limit("bytes of JSON", text.size(), kMostJsonBytes);
  const size_t first = std::min(text.find_first_not_of(" \t\r\n\xef\xbb\xbf"), text.size());
  if (text.substr(first, 1) != "{") return source.malformed("is neither a JSON object nor GLB", Place{"byte", first});
  GltfJsonBuilder builder(source);
  if (!json::sax_parse(text.begin(), text.end(), &builder)) return builder.error();
  document.json = builder.take();
  for (std::string_view name : kArrays) {
    const auto entry = document.json.find(std::string(name));
    if (entry != document.json.end() && !entry->is_array()) {
      return source.malformed(fmt::format("{} is not an array", name), "in the JSON");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<GltfDocument> parse_gltf_document(std::string bytes, const Source& source) {
  GltfDocument document;
  document.bytes = std::move(bytes);
  std::string_view text = document.bytes;
  absl::Status status;
  const bool glb = text.substr(0, 4) == "glTF";
  if (glb) status = split_glb(document, text, source);
  if (status.ok()) status = parse_json(text, document, source);
  if (status.ok()) status = check_version(document.json, source);
  if (status.ok()) status = check_extensions(document.json, source);
  if (!status.ok()) return status;
  document.looks = take_gltf_looks(document.json);
  document.animations = take_gltf_animations(document.json);
  absl::StatusOr<GltfExtensions> extensions = take_gltf_extensions(document.json, source);
  if (!extensions.ok()) return extensions.status();
  document.extensions = *std::move(extensions);
  status = check_gltf_types(document.json, source);
  if (!status.ok()) return status;
  if (!glb) document.bytes = {};
  const auto nodes = document.json.find("nodes");
  if (nodes != document.json.end() && nodes->size() > source.limits.max_nodes) {
    return source.over_limit("nodes", nodes->size(), source.limits.max_nodes);
  }
  return document;
}

}  // namespace diaphane::readers

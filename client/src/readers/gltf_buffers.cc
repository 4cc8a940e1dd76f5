#include "readers/gltf_buffers.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "readers/file.h"
#include "tiny_gltf.h"

namespace diaphane::readers {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// "%20" as " "; nothing where a percent sign stands for no byte.
std::optional<std::string> percent_decoded(std::string_view uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const std::string_view digits = uri.substr(i + 1, 2);
    unsigned char byte = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc() || stop != digits.data() + 2) return std::nullopt;
    text += static_cast<char>(byte);
    i += 2;
  }
  return text;
}

// Whether `uri` is a plain relative path: no scheme, no root, no step up, nothing that some systems read as those.
bool is_plain_relative(const std::string& path) {
  if (path.empty() || path.find_first_of(std::string_view("\0\\:", 3)) != std::string::npos) return false;
  const fs::path parsed(path);
  return parsed.is_relative() &&
         std::none_of(parsed.begin(), parsed.end(), [](const fs::path& p) { return p == ".."; });
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

absl::StatusOr<std::string> load_file(const std::string& uri, uint64_t max_bytes, const Source& source) {
  Source buffer = source;
  buffer.name = fmt::format("{} {}", source.name, in_quotes(uri));
  const std::optional<std::string> path = percent_decoded(uri);
  if (!path || !is_plain_relative(*path) || source.folder.empty()) {
    return buffer.malformed("may not be opened", "", "must be a relative path inside the file's own folder");
  }
  std::error_code error;
  const fs::path folder = fs::canonical(source.folder, error);
  if (error) return buffer.error(absl::StatusCode::kNotFound, "no such folder");
  const fs::path target = fs::canonical(folder / *path, error);
  if (error) return buffer.error(absl::StatusCode::kNotFound, "no such file");
  if (!is_inside(target, folder)) return buffer.malformed("is a link that leads out of the file's own folder");
  return read_whole_file(target, max_bytes, buffer);
}

// A buffer without data, in the place of which meshopt's compressed views are read.
bool is_fallback(const json& entry) {
  const auto extensions = entry.find("extensions");
  if (extensions == entry.end() || !extensions->is_object()) return false;
  return std::any_of(extensions->begin(), extensions->end(), [](const json& extension) {
    return extension.is_object() && extension.value("fallback", json(false)) == json(true);
  });
}

absl::StatusOr<std::vector<unsigned char>> decode_data_uri(const std::string& text, std::string_view where,
                                                           const Source& source) {
  std::string mime_type;
  std::vector<unsigned char> decoded;
  if (!tinygltf::IsDataURI(text) || !tinygltf::DecodeDataURI(&decoded, mime_type, text, 0, false)) {
    return source.malformed(fmt::format("data URI {}", in_quotes(text)), where, "must be base64 of a binary kind");
  }
  return decoded;
}

bool is_data_uri(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

}  // namespace

absl::StatusOr<std::string> load_gltf_uri(const std::string& uri, const Source& source) {
  if (!is_data_uri(uri)) return load_file(uri, source.limits.max_file_bytes, source);
  const absl::StatusOr<std::vector<unsigned char>> decoded = decode_data_uri(uri, {}, source);
  if (!decoded.ok()) return decoded.status();
  return std::string(decoded->begin(), decoded->end());
}

absl::StatusOr<GltfBuffers> GltfBuffers::load(GltfDocument& document, const Source& source) {
  GltfBuffers buffers;
  const auto list = document.json.find("buffers");
  if (list == document.json.end()) return buffers;
  uint64_t bytes_left = source.limits.max_file_bytes;
  for (size_t index = 0; index < list->size(); ++index) {
    const std::string where = fmt::format("buffer {}", index);
    json& entry = (*list)[index];
    const auto length = entry.is_object() ? entry.find("byteLength") : entry.end();
    if (!entry.is_object() || length == entry.end() || !length->is_number_unsigned() || length->get<uint64_t>() == 0) {
      return source.malformed("no byteLength", where, "must be 1 or more");
    }
    const auto uri = entry.find("uri");
    if (uri != entry.end() && !uri->is_string()) return source.malformed("uri is no string", where);

    std::string_view view;
    if (uri == entry.end()) {
      if (is_fallback(entry)) {
        buffers.views_.emplace_back();
        continue;
      }
      if (index != 0 || !document.has_chunk) return source.malformed("no uri and no binary chunk", where);
      view = document.binary_chunk();
    } else if (is_data_uri(uri->get_ref<const std::string&>())) {
      const std::string text = std::move(uri->get_ref<std::string&>());
      absl::StatusOr<std::vector<unsigned char>> decoded = decode_data_uri(text, where, source);
      if (!decoded.ok()) return decoded.status();
      buffers.decoded_.push_back(*std::move(decoded));
      view = {reinterpret_cast<const char*>(buffers.decoded_.back().data()), buffers.decoded_.back().size()};
    } else {
      Source buffer = source;
      buffer.name = fmt::format("{}: {}", source.name, where);
      absl::StatusOr<std::string> file = load_file(uri->get<std::string>(), bytes_left, buffer);
      if (!file.ok()) return file.status();
      bytes_left -= file->size();
      buffers.files_.push_back(*std::move(file));
      view = buffers.files_.back();
    }
    if (length->get<uint64_t>() > view.size()) {
      return source.malformed(fmt::format("byteLength {}", length->get<uint64_t>()), where,
                              fmt::format("there are {} bytes", view.size()));
    }
    buffers.views_.push_back(view.substr(0, length->get<size_t>()));
  }
  return buffers;
}

}  // namespace diaphane::readers

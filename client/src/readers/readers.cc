#include "diaphane/readers.h"

#include <new>

#include "readers/file.h"
#include "readers/format.h"
#include "readers/gltf.h"
#include "readers/obj.h"
#include "readers/off.h"
#include "readers/ply.h"
#include "readers/source.h"
#include "readers/stl.h"

namespace diaphane {
namespace {

constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";  // which some editors put before any text

absl::StatusOr<LoadedFile> read_as(readers::MeshFormat format, std::string bytes, const readers::Source& source) {
  switch (format) {
    case readers::MeshFormat::kGltf:
      return readers::read_gltf(std::move(bytes), source);
    case readers::MeshFormat::kObj:
      return readers::read_obj(bytes, source);
    case readers::MeshFormat::kOff:
      return readers::read_off(bytes, source);
    case readers::MeshFormat::kPly:
      return readers::read_ply(bytes, source);
    case readers::MeshFormat::kStl:
      return readers::read_stl(bytes, source);
  }
  return absl::InternalError("no such format");
}

}  // namespace

absl::StatusOr<LoadedFile> read_mesh_file(const std::filesystem::path& path, const ReadLimits& limits) {
  readers::Source source{path.string(), path.parent_path(), limits};
  if (source.folder.empty()) source.folder = ".";
  // Limits bound what is allocated, but not by what this machine has.
  try {
    absl::StatusOr<std::string> bytes = readers::read_whole_file(path, limits.max_file_bytes, source);
    if (!bytes.ok()) return bytes.status();
    if (bytes->starts_with(kUtf8Mark)) bytes->erase(0, kUtf8Mark.size());
    if (bytes->empty()) return source.malformed("is empty");
    const std::optional<readers::MeshFormat> format = readers::tell_format(*bytes, path.extension().string());
    if (!format) {
      return source.malformed("is no known kind of mesh file", "", "must be glTF, GLB, OBJ, PLY, STL or OFF");
    }
    return read_as(*format, *std::move(bytes), source);
  } catch (const std::bad_alloc&) {
    return source.error(absl::StatusCode::kResourceExhausted, "memory ran out");
  }
}

}  // namespace diaphane

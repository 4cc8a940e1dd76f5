// Which kind of mesh file some bytes are.
#pragma once

#include <optional>
#include <string_view>

namespace diaphane::readers {

enum class MeshFormat { kGltf, kObj, kOff, kPly, kStl };

/// By content where it tells (glTF, PLY, OFF, STL), else by `extension` (".obj", any case; may be empty); nothing where
/// neither does. Thread-safe.
std::optional<MeshFormat> tell_format(std::string_view bytes, std::string_view extension);

}  // namespace diaphane::readers

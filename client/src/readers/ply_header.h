// The header of a PLY file: which values follow it, in which order and form.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "readers/source.h"

namespace diaphane::readers {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

size_t size_of(PlyType type);
bool is_integer(PlyType type);
/// The largest value of an integer type.
double largest_of(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::kFloat32;  ///< of the value, or of each in the list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< lists only; an integer type
};

struct PlyElement {
  std::string_view name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The property called `property`, or -1.
  int find(std::string_view property) const;

  /// The same for several; lists count as none.
  template <size_t count>
  std::array<int, count> find_plain(const std::string_view (&names)[count]) const {
    std::array<int, count> found;
    for (size_t i = 0; i < count; ++i) {
      found[i] = find(names[i]);
      if (found[i] >= 0 && properties[static_cast<size_t>(found[i])].is_list) found[i] = -1;
    }
    return found;
  }
};

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  size_t body_offset = 0;  ///< the first byte after the header
  uint64_t body_line = 0;  ///< the line that it stands in
};

/// Parses the header of `bytes`, which outlive the result. Every element's count is checked to fit into the bytes that
/// follow the header. kInvalidArgument otherwise, naming the line.
absl::StatusOr<PlyHeader> parse_ply_header(std::string_view bytes, const Source& source);

}  // namespace diaphane::readers

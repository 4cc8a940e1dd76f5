#include "readers/stl.h"

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "fmt/format.h"
#include "readers/mesh_builder.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

constexpr size_t kHeaderBytes = 84;  // 80 of text, then the count
constexpr size_t kTriangleBytes = 50;
constexpr size_t kSniffedBytes = 4096;

uint32_t little_endian_u32(const char* bytes) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes, b.size());
  return uint32_t{b[0]} | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

class StlReader {
 public:
  StlReader(std::string_view bytes, const Source& source) : bytes_(bytes), source_(source), builder_(source) {}

  absl::StatusOr<LoadedFile> read() {
    const bool ascii = !is_binary_stl(bytes_) && looks_like_ascii_stl(bytes_);
    const absl::Status status = ascii ? read_ascii() : read_binary();
    if (!status.ok()) return status;
    return builder_.finish();
  }

 private:
  absl::Status add_corner(const Double3& position, Place place) {
    std::array<uint32_t, 3> key;
    for (size_t axis = 0; axis < 3; ++axis)
      key[axis] = std::bit_cast<uint32_t>(static_cast<float>(position[axis]) + 0.0f);
    const auto [entry, is_new] = vertex_at_.try_emplace(key, static_cast<uint32_t>(builder_.vertex_count()));
    corners_.push_back(entry->second);
    return is_new ? builder_.add_vertex(position, place) : absl::OkStatus();
  }

  absl::Status end_solid() {
    vertex_at_.clear();
    return builder_.end_mesh(name_);
  }

  absl::Status read_binary() {
    if (bytes_.size() < kHeaderBytes) {
      return source_.malformed(fmt::format("{} bytes", bytes_.size()), "", "binary STL has at least 84");
    }
    const uint64_t count = little_endian_u32(bytes_.data() + 80);
    const uint64_t room = (bytes_.size() - kHeaderBytes) / kTriangleBytes;
    if (count > room) {
      return source_.malformed(fmt::format("{} triangles", count), Place{"byte", 80},
                               fmt::format("there is room for {}", room));
    }
    if (count > source_.limits.max_triangles) {
      return source_.over_limit("triangles", count, source_.limits.max_triangles);
    }
    if (bytes_.size() > kHeaderBytes + count * kTriangleBytes) {
      builder_.warn(fmt::format("left out: {} bytes after the last triangle",
                                bytes_.size() - kHeaderBytes - count * kTriangleBytes));
    }
    for (uint64_t triangle = 0; triangle < count; ++triangle) {
      const size_t offset = kHeaderBytes + triangle * kTriangleBytes;
      corners_.clear();
      for (size_t corner = 1; corner <= 3; ++corner) {  // 0 is the facet normal
        Double3 position;
        for (size_t axis = 0; axis < 3; ++axis) {
          position[axis] = std::bit_cast<float>(little_endian_u32(bytes_.data() + offset + 12 * corner + 4 * axis));
        }
        const absl::Status status = add_corner(position, {"byte", offset + 12 * corner});
        if (!status.ok()) return status;
      }
      const absl::Status status = builder_.add_polygon(corners_, {"byte", offset});
      if (!status.ok()) return status;
    }
    return end_solid();
  }

  absl::Status read_ascii() {
    LineReader lines(bytes_);
    std::string_view rest;
    while (lines.next(rest)) {
      const std::string_view line = rest;
      const std::string_view keyword = next_token(rest);
      const auto is = [keyword](std::string_view name) { return equals_ignoring_case(keyword, name); };
      absl::Status status;
      if (is("vertex")) {
        status = read_vertex(rest, lines.place());
      } else if (is("facet")) {
        if (in_facet_) return source_.malformed("a facet within a facet", lines.place());
        in_facet_ = true;
        corners_.clear();
      } else if (is("endfacet")) {
        if (!in_facet_ || corners_.size() < 3) {
          return source_.malformed(fmt::format("a facet of {} vertices ends", corners_.size()), lines.place(),
                                   "must have at least 3");
        }
        in_facet_ = false;
        status = builder_.add_polygon(corners_, lines.place());
      } else if (is("solid") || is("endsolid")) {
        if (in_facet_) return source_.malformed("a solid ends within a facet", lines.place());
        status = end_solid();
        name_ = is("solid") ? trimmed(line.substr(static_cast<size_t>(keyword.data() + keyword.size() - line.data())))
                            : std::string_view();
      } else if (!keyword.empty() && !is("outer") && !is("endloop")) {
        return source_.malformed(fmt::format("{} is no keyword of STL", in_quotes(keyword)), lines.place());
      }
      if (!status.ok()) return status;
    }
    if (in_facet_) return source_.malformed("ends within a facet", lines.place());
    return end_solid();
  }

  absl::Status read_vertex(std::string_view rest, Place place) {
    if (!in_facet_) return source_.malformed("a vertex outside of a facet", place);
    Double3 position;
    for (double& number : position) {
      const std::string_view token = next_token(rest);
      if (!parse_number(token, number)) {
        return source_.malformed(fmt::format("vertex coordinate {}", in_quotes(token)), place, "must be three numbers");
      }
    }
    const absl::Status status = builder_.check_corner_count(corners_.size() + 1);
    return status.ok() ? add_corner(position, place) : status;
  }

  static std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
  }

  std::string_view bytes_;
  const Source& source_;
  MeshBuilder builder_;
  absl::flat_hash_map<std::array<uint32_t, 3>, uint32_t> vertex_at_;
  std::vector<int64_t> corners_;
  std::string_view name_;
  bool in_facet_ = false;
};

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes &&
         bytes.size() == kHeaderBytes + uint64_t{little_endian_u32(bytes.data() + 80)} * kTriangleBytes;
}

bool looks_like_ascii_stl(std::string_view bytes) {
  LineReader lines(bytes.substr(0, kSniffedBytes));
  std::string_view line;
  bool solid = false;
  while (lines.next(line)) {
    const std::string_view keyword = next_token(line);
    if (keyword.empty()) continue;
    if (solid) return equals_ignoring_case(keyword, "facet") || equals_ignoring_case(keyword, "endsolid");
    if (!equals_ignoring_case(keyword, "solid")) return false;
    solid = true;
  }
  return false;
}

absl::StatusOr<LoadedFile> read_stl(std::string_view bytes, const Source& source) {
  return StlReader(bytes, source).read();
}

}  // namespace diaphane::readers

#include "readers/off.h"

#include <array>
#include <vector>

#include "fmt/format.h"
#include "readers/mesh_builder.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

// The parts of "STCN4nOFF", in which the keyword may name what each vertex has besides its position.
struct Keyword {
  bool is_off = false;
  bool normals = false;
  bool colours = false;
  bool texture_coordinates = false;
  bool other_dimension = false;
  size_t length = 0;  // some files write the first count right behind the keyword
};

Keyword parse_keyword(std::string_view token) {
  Keyword keyword;
  std::string_view rest = token;
  const auto take = [&rest](std::string_view prefix) {
    const bool has = rest.substr(0, prefix.size()) == prefix;
    if (has) rest.remove_prefix(prefix.size());
    return has;
  };
  keyword.texture_coordinates = take("ST");
  keyword.colours = take("C");
  keyword.normals = take("N");
  keyword.other_dimension = take("4");
  keyword.other_dimension |= take("n");
  keyword.is_off = take("OFF") && (rest.empty() || (rest[0] >= '0' && rest[0] <= '9'));
  keyword.length = token.size() - rest.size();
  return keyword;
}

class OffReader {
 public:
  OffReader(std::string_view text, const Source& source)
      : lines_(text), source_(source), builder_(source), text_bytes_(text.size()) {}

  absl::StatusOr<LoadedFile> read() {
    absl::Status status = read_header();
    for (uint64_t i = 0; i < vertices_ && status.ok(); ++i) status = read_vertex(static_cast<uint32_t>(i));
    for (uint64_t i = 0; i < faces_ && status.ok(); ++i) status = read_face();
    builder_.code_colours(ColourCoding::kSrgbOrBytes);
    if (status.ok()) status = builder_.end_mesh("");
    if (!status.ok()) return status;
    return builder_.finish();
  }

 private:
  // The next line that holds anything but a comment.
  bool next_line(std::string_view& rest) {
    std::string_view line;
    while (lines_.next(line)) {
      rest = line;
      if (!next_token(line).empty()) return true;
    }
    return false;
  }

  absl::Status truncated(std::string_view what) const {
    return source_.malformed(fmt::format("ends before {}", what), lines_.place(),
                             fmt::format("must have {} vertices and {} faces", vertices_, faces_));
  }

  absl::Status read_header() {
    std::string_view line;
    if (!next_line(line)) return source_.malformed("is empty");
    std::string_view rest = line;
    const std::string_view token = next_token(rest);
    keyword_ = parse_keyword(token);
    if (!keyword_.is_off) return source_.malformed(fmt::format("{} at its start", in_quotes(token)), "", "must be OFF");
    if (keyword_.other_dimension) return source_.unsupported("OFF of other than three dimensions");

    rest = line.substr(static_cast<size_t>(token.data() - line.data()) + keyword_.length);
    std::string_view after = rest;
    const std::string_view first = next_token(after);
    if (first == "BINARY") return source_.unsupported("binary OFF");
    if (first.empty() && !next_line(rest)) return source_.malformed("ends before its counts");
    uint64_t edges = 0;
    absl::Status status = read_count(rest, "vertices", true, vertices_);
    if (status.ok()) status = read_count(rest, "faces", true, faces_);
    if (status.ok()) status = read_count(rest, "edges", false, edges);
    if (!status.ok()) return status;
    // A vertex takes at least "0 0 0\n", a face "0\n".
    if (vertices_ > text_bytes_ / 6 + 1 || faces_ > text_bytes_ / 2 + 1) {
      return source_.malformed(fmt::format("{} vertices and {} faces", vertices_, faces_), lines_.place(),
                               fmt::format("cannot be in {} bytes", text_bytes_));
    }
    return builder_.expect(vertices_, faces_);
  }

  absl::Status read_count(std::string_view& rest, std::string_view what, bool required, uint64_t& count) {
    const std::string_view token = next_token(rest);
    if (token.empty() && !required) return absl::OkStatus();
    int64_t value = 0;
    if (!parse_integer(token, value) || value < 0) {
      return source_.malformed(fmt::format("count of {} {}", what, in_quotes(token)), lines_.place(),
                               "must be an integer of at least 0");
    }
    count = static_cast<uint64_t>(value);
    return absl::OkStatus();
  }

  absl::Status read_three(std::string_view& rest, std::string_view what, Double3& value) {
    for (double& number : value) {
      const std::string_view token = next_token(rest);
      if (!parse_number(token, number)) {
        return source_.malformed(fmt::format("{} {}", what, in_quotes(token)), lines_.place(), "must be three numbers");
      }
    }
    return absl::OkStatus();
  }

  absl::Status read_vertex(uint32_t vertex) {
    std::string_view rest;
    if (!next_line(rest)) return truncated(fmt::format("vertex {}", vertex));
    Double3 position, normal;
    absl::Status status = read_three(rest, "position", position);
    if (status.ok()) status = builder_.add_vertex(position, lines_.place());
    if (!status.ok()) return status;
    if (keyword_.normals) {
      status = read_three(rest, "normal", normal);
      if (!status.ok()) return status;
      builder_.set_normal(vertex, normal);
    }
    return keyword_.colours || keyword_.texture_coordinates ? read_looks(rest, vertex) : absl::OkStatus();
  }

  // "r g b", "r g b a", "s t", or one of the former and the latter: files differ in whether there is an alpha.
  absl::Status read_looks(std::string_view rest, uint32_t vertex) {
    std::array<double, 6> values;
    size_t count = 0;
    while (count < values.size() && parse_number(next_token(rest), values[count])) ++count;
    const size_t coordinates = keyword_.texture_coordinates ? 2 : 0;
    const size_t least = (keyword_.colours ? 3 : 0) + coordinates;
    if (count < least) {
      return source_.malformed(fmt::format("{} numbers after position and normal", count), lines_.place(),
                               fmt::format("must be {} or more", least));
    }
    if (keyword_.colours) builder_.set_colour(vertex, {values[0], values[1], values[2]});
    if (coordinates > 0) {
      const size_t first = keyword_.colours ? count - coordinates : 0;
      builder_.set_texture_coordinate(vertex, values[first], values[first + 1]);
    }
    return absl::OkStatus();
  }

  absl::Status read_face() {
    std::string_view rest;
    if (!next_line(rest)) return truncated("its last face");
    uint64_t count = 0;
    absl::Status status = read_count(rest, "corners", true, count);
    if (status.ok()) status = builder_.check_corner_count(count);
    if (!status.ok()) return status;
    corners_.clear();
    for (uint64_t i = 0; i < count; ++i) {
      int64_t corner = 0;
      const std::string_view token = next_token(rest);
      if (!parse_integer(token, corner)) {
        return source_.malformed(fmt::format("vertex index {}", in_quotes(token)), lines_.place(),
                                 fmt::format("must be {} integers", count));
      }
      corners_.push_back(corner);
    }
    return builder_.add_polygon(corners_, lines_.place());
  }

  LineReader lines_;
  const Source& source_;
  MeshBuilder builder_;
  const uint64_t text_bytes_;
  Keyword keyword_;
  uint64_t vertices_ = 0;
  uint64_t faces_ = 0;
  std::vector<int64_t> corners_;
};

}  // namespace

bool looks_like_off(std::string_view text) {
  LineReader lines(text.substr(0, 4096));
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view token = next_token(line);
    if (!token.empty()) return parse_keyword(token).is_off;
  }
  return false;
}

absl::StatusOr<LoadedFile> read_off(std::string_view text, const Source& source) {
  return OffReader(text, source).read();
}

}  // namespace diaphane::readers

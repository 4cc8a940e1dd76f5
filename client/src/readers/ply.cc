#include "readers/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "fmt/format.h"
#include "readers/mesh_builder.h"
#include "readers/ply_header.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

constexpr double kLargestIndex = 4294967295.0;

// Values one after the other, blanks and line ends between them alike.
class AsciiValues {
 public:
  AsciiValues(std::string_view bytes, const PlyHeader& header)
      : rest_(bytes.substr(header.body_offset)), line_(header.body_line) {}

  bool read(PlyType, double& value) {
    skip_blanks();
    size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    const std::string_view token = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return parse_number(token, value);
  }

  /// The most values of a type that may still follow.
  uint64_t most_left(PlyType) const { return rest_.size() / 2 + 1; }
  /// Of the value read last.
  Place last_place() const { return {"line", line_}; }
  /// Of the value to be read next.
  Place next_place() {
    skip_blanks();
    return last_place();
  }

 private:
  void skip_blanks() {
    size_t count = 0;
    while (count < rest_.size() && is_blank(rest_[count])) line_ += ends_line(count++);
    rest_.remove_prefix(count);
  }
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  bool ends_line(size_t i) const { return rest_[i] == '\n' || (rest_[i] == '\r' && rest_.substr(i, 2) != "\r\n"); }

  std::string_view rest_;
  uint64_t line_;
};

class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, const PlyHeader& header)
      : bytes_(bytes), offset_(header.body_offset), big_endian_(header.format == PlyFormat::kBigEndian) {}

  bool read(PlyType type, double& value) {
    const size_t size = size_of(type);
    if (bytes_.size() - offset_ < size) return false;
    uint64_t bits = 0;
    for (size_t i = 0; i < size; ++i) {
      const size_t at = offset_ + (big_endian_ ? i : size - 1 - i);
      bits = bits << 8 | static_cast<unsigned char>(bytes_[at]);
    }
    offset_ += size;
    value = to_number(type, bits);
    return true;
  }

  uint64_t most_left(PlyType type) const { return (bytes_.size() - offset_) / size_of(type); }
  Place last_place() const { return {"byte", offset_}; }
  Place next_place() const { return last_place(); }

 private:
  static double to_number(PlyType type, uint64_t bits) {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<int8_t>(bits);
      case PlyType::kInt16:
        return static_cast<int16_t>(bits);
      case PlyType::kInt32:
        return static_cast<int32_t>(bits);
      case PlyType::kFloat32:
        return std::bit_cast<float>(static_cast<uint32_t>(bits));
      case PlyType::kFloat64:
        return std::bit_cast<double>(bits);
      default:
        return static_cast<double>(bits);
    }
  }

  std::string_view bytes_;
  size_t offset_;
  bool big_endian_;
};

template <typename Values>
class PlyReader {
 public:
  PlyReader(std::string_view bytes, const PlyHeader& header, const Source& source)
      : values_(bytes, header), header_(header), source_(source), builder_(source) {}

  absl::StatusOr<LoadedFile> read() {
    for (const PlyElement& element : header_.elements) {
      absl::Status status;
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        status = read_vertices(element);
      } else {
        status = read_others(element);
      }
      if (!status.ok()) return status;
    }
    const absl::Status status = builder_.end_mesh("");
    if (!status.ok()) return status;
    return builder_.finish();
  }

 private:
  // One row: plain values into row_[property], the list of property `wanted_list` into list_.
  absl::Status read_row(const PlyElement& element, int wanted_list) {
    row_.resize(element.properties.size());
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const bool read = values_.read(property.is_list ? property.count_type : property.type, row_[i]);
      if (!read) return bad_value(element, property);
      if (!property.is_list) continue;
      const absl::Status status = read_list(element, property, row_[i], static_cast<int>(i) == wanted_list);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status read_list(const PlyElement& element, const PlyProperty& property, double count, bool wanted) {
    const auto most = static_cast<double>(values_.most_left(property.type));
    if (!(count >= 0) || count > most || count != static_cast<double>(static_cast<uint64_t>(count))) {
      return source_.malformed(fmt::format("a list of {} {}", count, in_quotes(property.name)), values_.last_place(),
                               fmt::format("must be 0..{} to fit into the rest of the file", most));
    }
    const auto size = static_cast<uint64_t>(count);
    list_.clear();
    if (wanted && size > longest_list_) return source_.over_limit("indices in a list", size, longest_list_);
    if (wanted) list_.reserve(size);
    for (uint64_t i = 0; i < size; ++i) {
      double value = 0;
      if (!values_.read(property.type, value)) return bad_value(element, property);
      if (!wanted) continue;
      if (!(std::abs(value) <= kLargestIndex) || value != std::trunc(value)) {
        return source_.malformed(fmt::format("vertex index {}", value), values_.last_place(), "must be an integer");
      }
      list_.push_back(static_cast<int64_t>(value));
    }
    return absl::OkStatus();
  }

  absl::Status bad_value(const PlyElement& element, const PlyProperty& property) const {
    return source_.malformed(
        fmt::format("element {} ends early or has no number for {}", in_quotes(element.name), in_quotes(property.name)),
        values_.last_place(), fmt::format("must have {} rows", element.count));
  }

  absl::Status read_vertices(const PlyElement& element) {
    static constexpr std::string_view kPosition[] = {"x", "y", "z"};
    const Columns<3> position = element.find_plain(kPosition);
    for (size_t axis = 0; axis < 3; ++axis) {
      if (position[axis] < 0) {
        return source_.malformed(fmt::format("element vertex has no plain property {}", kPosition[axis]),
                                 "in the header");
      }
    }
    const Columns<3> normal = element.find_plain({"nx", "ny", "nz"});
    const Columns<3> colour = element.find_plain({"red", "green", "blue"});
    const double colour_scale = find_colour_scale(element, colour);
    Columns<2> texture = element.find_plain({"s", "t"});
    if (!are_all(texture)) texture = element.find_plain({"u", "v"});
    if (!are_all(texture)) texture = element.find_plain({"texture_u", "texture_v"});

    absl::Status status = builder_.expect(element.count, 0);
    if (!status.ok()) return status;
    const auto three = [this](const Columns<3>& at, double scale = 1) {
      return Double3{scale * row_[static_cast<size_t>(at[0])], scale * row_[static_cast<size_t>(at[1])],
                     scale * row_[static_cast<size_t>(at[2])]};
    };
    for (uint64_t i = 0; i < element.count; ++i) {
      const Place place = values_.next_place();
      status = read_row(element, -1);
      if (status.ok()) status = builder_.add_vertex(three(position), place);
      if (!status.ok()) return status;
      const auto vertex = static_cast<uint32_t>(i);
      if (are_all(normal)) builder_.set_normal(vertex, three(normal));
      if (are_all(colour)) builder_.set_colour(vertex, three(colour, colour_scale));
      if (are_all(texture)) {
        builder_.set_texture_coordinate(vertex, row_[static_cast<size_t>(texture[0])],
                                        row_[static_cast<size_t>(texture[1])]);
      }
    }
    has_vertices_ = true;
    return absl::OkStatus();
  }

  template <size_t count>
  using Columns = std::array<int, count>;

  template <size_t count>
  static bool are_all(const Columns<count>& columns) {
    return std::all_of(columns.begin(), columns.end(), [](int column) { return column >= 0; });
  }

  // Integers are sRGB over their type's range, floating-point numbers are linear already.
  double find_colour_scale(const PlyElement& element, const Columns<3>& colour) {
    if (!are_all(colour)) return 1;
    const PlyType type = element.properties[static_cast<size_t>(colour[0])].type;
    if (!is_integer(type)) return 1;
    builder_.code_colours(ColourCoding::kSrgb);
    return 1 / largest_of(type);
  }

  absl::Status read_others(const PlyElement& element) {
    const bool strips = element.name == "tristrips";
    int indices = -1;
    if (strips || element.name == "face") {
      indices = std::max(element.find("vertex_indices"), element.find("vertex_index"));
    }
    if (indices >= 0 && element.count > 0) {
      const PlyProperty& property = element.properties[static_cast<size_t>(indices)];
      if (!property.is_list || !is_integer(property.type)) {
        return source_.malformed(fmt::format("property {}", in_quotes(property.name)), "in the header",
                                 "must be a list of an integer type");
      }
      if (!has_vertices_) return source_.unsupported("PLY with faces before its vertices");
    }
    longest_list_ = strips ? 2 * source_.limits.max_triangles : MeshBuilder::kMostCorners;
    for (uint64_t i = 0; i < element.count; ++i) {
      const Place place = values_.next_place();
      absl::Status status = read_row(element, indices);
      if (status.ok() && indices >= 0) status = strips ? add_strips(place) : add_face(place);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status add_face(Place place) { return builder_.add_polygon(list_, place); }

  // Every corner after a strip's second makes a triangle with the two before it, every other one turned round.
  absl::Status add_strips(Place place) {
    size_t begin = 0;
    for (size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) {
        begin = i + 1;
      } else if (i >= begin + 2) {
        const bool turned = (i - begin) % 2 == 1;
        std::array<int64_t, 3> corners = {list_[i - 2], list_[i - 1], list_[i]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;  // stitches
        if (turned) std::swap(corners[0], corners[1]);
        const absl::Status status = builder_.add_polygon(corners, place);
        if (!status.ok()) return status;
      }
    }
    return absl::OkStatus();
  }

  Values values_;
  const PlyHeader& header_;
  const Source& source_;
  MeshBuilder builder_;
  std::vector<double> row_;
  std::vector<int64_t> list_;
  uint64_t longest_list_ = 0;
  bool has_vertices_ = false;
};

}  // namespace

absl::StatusOr<LoadedFile> read_ply(std::string_view bytes, const Source& source) {
  const absl::StatusOr<PlyHeader> header = parse_ply_header(bytes, source);
  if (!header.ok()) return header.status();
  if (header->format == PlyFormat::kAscii) return PlyReader<AsciiValues>(bytes, *header, source).read();
  return PlyReader<BinaryValues>(bytes, *header, source).read();
}

}  // namespace diaphane::readers

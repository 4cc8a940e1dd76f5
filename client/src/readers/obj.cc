#include "readers/obj.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "fmt/format.h"
#include "readers/mesh_builder.h"
#include "readers/obj_vertices.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

constexpr std::string_view kPassedOver[] = {"vp",     "g",      "o",      "s",      "mg",  "p",          "l",
                                            "mtllib", "usemtl", "usemap", "maplib", "lod", "shadow_obj", "trace_obj"};

// Two passes, so that faces may come before what they refer to: values first, then faces.
class ObjReader {
 public:
  ObjReader(std::string_view text, const Source& source)
      : text_(text), source_(source), builder_(source), vertices_(normals_, textures_, builder_) {}

  absl::StatusOr<LoadedFile> read() {
    for (const bool faces : {false, true}) {
      const absl::Status status = pass(faces);
      if (!status.ok()) return status;
    }
    if (skipped_ > 0) {
      builder_.warn(fmt::format("left out: {} statements of unknown kinds, the first {} at {}", skipped_,
                                first_skipped_, to_string(first_skipped_at_)));
    }
    const uint64_t vertices = builder_.vertex_count();
    builder_.code_colours(ColourCoding::kSrgbOrBytes);
    const absl::Status status = builder_.end_mesh("");
    if (!status.ok()) return status;
    absl::StatusOr<LoadedFile> file = builder_.finish();
    if (!file.ok() && vertices == 0 && skipped_ > 0) {
      return source_.malformed(fmt::format("nothing to render: no statement of an OBJ file, but {}", first_skipped_),
                               first_skipped_at_);
    }
    return file;
  }

 private:
  absl::Status pass(bool faces) {
    LineReader lines(text_);
    std::string_view rest;
    positions_so_far_ = textures_so_far_ = normals_so_far_ = 0;
    while (lines.next(rest, true)) {
      place_ = lines.place();
      const std::string_view keyword = next_token(rest);
      absl::Status status;
      if (keyword == "v") {
        ++positions_so_far_;
        if (!faces) status = read_position(rest);
      } else if (keyword == "vn") {
        ++normals_so_far_;
        if (!faces) status = read_normal(rest);
      } else if (keyword == "vt") {
        ++textures_so_far_;
        if (!faces) status = read_texture_coordinate(rest);
      } else if (faces && (keyword == "f" || keyword == "fo")) {
        status = read_face(rest);
      } else if (!faces) {
        note_skipped(keyword);
      }
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  void note_skipped(std::string_view keyword) {
    if (keyword.empty() || keyword == "f" || keyword == "fo") return;
    for (std::string_view known : kPassedOver) {
      if (keyword == known) return;
    }
    if (skipped_++ == 0) {
      first_skipped_ = in_quotes(keyword);
      first_skipped_at_ = place_;
    }
  }

  // Numbers up to the end of the line, at least `required`; those that are missing beyond stay as they are.
  absl::Status read_numbers(std::string_view& rest, std::string_view what, size_t required, std::span<double> numbers) {
    for (size_t i = 0; i < numbers.size(); ++i) {
      const std::string_view token = next_token(rest);
      if (token.empty() && i >= required) break;
      if (token.empty()) {
        return source_.malformed(fmt::format("{} ends early", what), place_,
                                 fmt::format("must have {} numbers", required));
      }
      if (!parse_number(token, numbers[i])) {
        return source_.malformed(fmt::format("{} {}", what, in_quotes(token)), place_, "must be a number");
      }
    }
    return absl::OkStatus();
  }

  // Three more numbers are a colour, one more is a weight, four are both.
  absl::Status read_position(std::string_view rest) {
    Double3 position;
    absl::Status status = read_numbers(rest, "position", position.size(), position);
    if (status.ok()) status = builder_.add_vertex(position, place_);
    if (!status.ok()) return status;
    Double3 colour;
    std::array<double, 4> more;
    size_t count = 0;
    while (count < more.size() && parse_number(next_token(rest), more[count])) ++count;
    if (count < colour.size()) return absl::OkStatus();
    std::copy(more.begin() + static_cast<std::ptrdiff_t>(count - colour.size()),
              more.begin() + static_cast<std::ptrdiff_t>(count), colour.begin());
    builder_.set_colour(static_cast<uint32_t>(builder_.vertex_count() - 1), colour);
    return absl::OkStatus();
  }

  absl::Status read_normal(std::string_view rest) {
    if (normals_.size() >= source_.limits.max_vertices) {
      return source_.over_limit("normals", normals_.size() + 1, source_.limits.max_vertices);
    }
    return read_numbers(rest, "normal", 3, normals_.emplace_back());
  }

  absl::Status read_texture_coordinate(std::string_view rest) {
    if (textures_.size() >= source_.limits.max_vertices) {
      return source_.over_limit("texture coordinates", textures_.size() + 1, source_.limits.max_vertices);
    }
    std::array<double, 2> uv{};
    const absl::Status status = read_numbers(rest, "texture coordinate", 1, uv);
    textures_.push_back({uv[0], uv[1]});
    return status;
  }

  absl::Status read_face(std::string_view rest) {
    corners_.clear();
    if (position_count_ < 0) position_count_ = static_cast<int64_t>(builder_.vertex_count());
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
      std::array<int64_t, 3> indices{};
      if (!split_corner(token, indices)) {
        return source_.malformed(fmt::format("face corner {}", in_quotes(token)), place_,
                                 "must be v, v/vt, v//vn or v/vt/vn");
      }
      auto& [position, texture, normal] = indices;
      absl::Status status = resolve("vertex index", positions_so_far_, position_count_, position);
      if (status.ok()) {
        status = resolve_optional("texture coordinate index", textures_so_far_, textures_.size(), texture);
      }
      if (status.ok()) status = resolve_optional("normal index", normals_so_far_, normals_.size(), normal);
      if (status.ok()) status = builder_.check_corner_count(corners_.size() + 1);
      if (!status.ok()) return status;
      const absl::StatusOr<uint32_t> vertex = vertices_.vertex_of(
          {static_cast<uint32_t>(position), static_cast<int32_t>(texture), static_cast<int32_t>(normal)});
      if (!vertex.ok()) return vertex.status();
      corners_.push_back(*vertex);
    }
    return builder_.add_polygon(corners_, place_);
  }

  // "v", "v/vt", "v//vn", "v/vt/vn"; what is not there stays 0, which is no index.
  static bool split_corner(std::string_view token, std::array<int64_t, 3>& indices) {
    for (size_t part = 0; part < indices.size(); ++part) {
      const size_t slash = token.find('/');
      const std::string_view text = token.substr(0, slash);
      const bool left_out = part > 0 && text.empty();
      // An explicit 0 is as wrong for what may be left out as for a position.
      if (!left_out && (!parse_integer(text, indices[part]) || (part > 0 && indices[part] == 0))) return false;
      if (slash == std::string_view::npos) return true;
      token.remove_prefix(slash + 1);
    }
    return false;
  }

  // resolve(), and -1 for what is not there.
  absl::Status resolve_optional(std::string_view what, int64_t so_far, size_t count, int64_t& index) const {
    if (index != 0) return resolve(what, so_far, static_cast<int64_t>(count), index);
    index = -1;
    return absl::OkStatus();
  }

  // From a file's index (1 is the first, -1 the latest so far) to one from 0.
  absl::Status resolve(std::string_view what, int64_t so_far, int64_t count, int64_t& index) const {
    const int64_t resolved = index > 0 ? index - 1 : index < 0 && index >= -so_far ? so_far + index : -1;
    if (resolved < 0 || resolved >= count) {
      std::string range = count == 0 ? "there are none" : fmt::format("must be 1..{}", count);
      if (so_far > 0) range += fmt::format(" or -{}..-1", so_far);
      return source_.malformed(fmt::format("{} {}", what, index), place_, range);
    }
    index = resolved;
    return absl::OkStatus();
  }

  std::string_view text_;
  const Source& source_;
  MeshBuilder builder_;
  std::vector<Double3> normals_;
  std::vector<ObjTextureCoordinate> textures_;
  ObjVertices vertices_;
  std::vector<int64_t> corners_;
  Place place_{"line", 0};
  int64_t position_count_ = -1;
  int64_t positions_so_far_ = 0;
  int64_t textures_so_far_ = 0;
  int64_t normals_so_far_ = 0;
  uint64_t skipped_ = 0;
  std::string first_skipped_;
  Place first_skipped_at_;
};

}  // namespace

absl::StatusOr<LoadedFile> read_obj(std::string_view text, const Source& source) {
  return ObjReader(text, source).read();
}

}  // namespace diaphane::readers

#include "readers/obj.h"

#include <array>
#include <charconv>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "fmt/format.h"
#include "readers/mesh_builder.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

constexpr std::string_view kPassedOver[] = {"vt",     "vp",     "g",   "o",          "s",
                                            "mg",     "p",      "l",   "mtllib",     "usemtl",
                                            "usemap", "maplib", "lod", "shadow_obj", "trace_obj"};

// Two passes, so that faces may come before what they refer to: values first, then faces.
class ObjReader {
 public:
  ObjReader(std::string_view text, const Source& source) : text_(text), source_(source), builder_(source) {}

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
    positions_so_far_ = normals_so_far_ = 0;
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

  absl::Status read_three(std::string_view rest, std::string_view what, Double3& value) {
    for (double& number : value) {
      const std::string_view token = next_token(rest);
      if (token.empty()) return source_.malformed(fmt::format("{} ends early", what), place_, "must have 3 numbers");
      if (!parse_number(token, number)) {
        return source_.malformed(fmt::format("{} {}", what, in_quotes(token)), place_, "must be a number");
      }
    }
    return absl::OkStatus();
  }

  // A weight or a colour may follow; neither is read.
  absl::Status read_position(std::string_view rest) {
    Double3 position;
    const absl::Status status = read_three(rest, "position", position);
    return status.ok() ? builder_.add_vertex(position, place_) : status;
  }

  absl::Status read_normal(std::string_view rest) {
    if (normals_.size() >= source_.limits.max_vertices) {
      return source_.over_limit("normals", normals_.size() + 1, source_.limits.max_vertices);
    }
    return read_three(rest, "normal", normals_.emplace_back());
  }

  absl::Status read_face(std::string_view rest) {
    corners_.clear();
    if (position_count_ < 0) start_faces();
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
      int64_t position = 0, normal = 0;
      if (!split_corner(token, position, normal)) {
        return source_.malformed(fmt::format("face corner {}", in_quotes(token)), place_,
                                 "must be v, v/vt, v//vn or v/vt/vn");
      }
      absl::Status status = resolve("vertex index", positions_so_far_, position_count_, position);
      if (status.ok() && normal != 0) {
        status = resolve("normal index", normals_so_far_, static_cast<int64_t>(normals_.size()), normal);
      } else {
        normal = -1;
      }
      if (status.ok() && normal >= 0) status = vertex_with_normal(static_cast<int32_t>(normal), position);
      if (status.ok()) status = builder_.check_corner_count(corners_.size() + 1);
      if (!status.ok()) return status;
      corners_.push_back(position);
    }
    return builder_.add_polygon(corners_, place_);
  }

  void start_faces() {
    position_count_ = static_cast<int64_t>(builder_.vertex_count());
    if (!normals_.empty()) normal_of_vertex_.assign(builder_.vertex_count(), -1);
  }

  // "v", "v/vt", "v//vn", "v/vt/vn"; `normal` stays 0 where there is none.
  static bool split_corner(std::string_view token, int64_t& position, int64_t& normal) {
    std::array<std::string_view, 3> parts;
    size_t count = 0;
    while (true) {
      const size_t slash = token.find('/');
      parts[count++] = token.substr(0, slash);
      if (slash == std::string_view::npos) break;
      token.remove_prefix(slash + 1);
      if (count == parts.size()) return false;
    }
    int64_t ignored = 0;
    if (!parse_integer(parts[0], position)) return false;
    if (!parts[1].empty() && !parse_integer(parts[1], ignored)) return false;
    // An explicit index 0 is as wrong for a normal as for a position.
    return parts[2].empty() || (parse_integer(parts[2], normal) && normal != 0);
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

  // The vertex at `position` that has `normal`: the first normal takes the vertex itself, others get copies.
  absl::Status vertex_with_normal(int32_t normal, int64_t& position) {
    const auto vertex = static_cast<uint32_t>(position);
    if (normal_of_vertex_[vertex] < 0) {
      normal_of_vertex_[vertex] = normal;
      builder_.set_normal(vertex, normals_[static_cast<size_t>(normal)]);
    }
    if (normal_of_vertex_[vertex] == normal) return absl::OkStatus();
    const auto [entry, is_new] =
        copies_.try_emplace({vertex, static_cast<uint32_t>(normal)}, static_cast<uint32_t>(builder_.vertex_count()));
    position = entry->second;
    if (!is_new) return absl::OkStatus();
    const absl::Status status = builder_.repeat_vertex(vertex);
    if (status.ok()) builder_.set_normal(entry->second, normals_[static_cast<size_t>(normal)]);
    return status;
  }

  std::string_view text_;
  const Source& source_;
  MeshBuilder builder_;
  std::vector<Double3> normals_;
  std::vector<int32_t> normal_of_vertex_;
  absl::flat_hash_map<std::array<uint32_t, 2>, uint32_t> copies_;
  std::vector<int64_t> corners_;
  Place place_{"line", 0};
  int64_t position_count_ = -1;
  int64_t positions_so_far_ = 0;
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

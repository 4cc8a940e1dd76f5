#include "readers/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

constexpr size_t kLongestName = 120;

bool fits_float(double value) { return std::abs(value) <= std::numeric_limits<float>::max(); }

Vec3 to_float(const Double3& value) {
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

}  // namespace

absl::Status MeshBuilder::expect(uint64_t vertices, uint64_t triangles) {
  const ReadLimits& limits = source_.limits;
  if (vertices > limits.max_vertices) return source_.over_limit("vertices", vertices, limits.max_vertices);
  if (triangles > limits.max_triangles) return source_.over_limit("triangles", triangles, limits.max_triangles);
  mesh_.positions.reserve(vertices);
  mesh_.triangles.reserve(3 * triangles);
  return absl::OkStatus();
}

absl::Status MeshBuilder::add_vertex(const Double3& position, Place place) {
  if (!fits_float(position[0]) || !fits_float(position[1]) || !fits_float(position[2])) {
    return source_.malformed(fmt::format("position {}, {}, {}", position[0], position[1], position[2]), place,
                             "must be finite");
  }
  if (++vertices_ > source_.limits.max_vertices) {
    return source_.over_limit("vertices", vertices_, source_.limits.max_vertices);
  }
  mesh_.positions.push_back(to_float(position));
  return absl::OkStatus();
}

absl::Status MeshBuilder::repeat_vertex(uint32_t vertex) {
  if (++vertices_ > source_.limits.max_vertices) {
    return source_.over_limit("vertices", vertices_, source_.limits.max_vertices);
  }
  mesh_.positions.push_back(Vec3(mesh_.positions[vertex]));
  if (vertex < mesh_.colors.size()) {
    mesh_.colors.resize(mesh_.positions.size() - 1, kNoColour);
    mesh_.colors.push_back(Rgb(mesh_.colors[vertex]));
  }
  return absl::OkStatus();
}

void MeshBuilder::set_normal(uint32_t vertex, const Double3& normal) {
  if (mesh_.normals.size() <= vertex) mesh_.normals.resize(size_t{vertex} + 1);
  const auto fits = [](double coordinate) { return std::abs(coordinate) <= kLargestNormal; };
  if (fits(normal[0]) && fits(normal[1]) && fits(normal[2])) {
    mesh_.normals[vertex] = to_float(normal);
  } else {
    ++bad_normals_;
  }
}

void MeshBuilder::set_colour(uint32_t vertex, const Double3& colour) {
  if (mesh_.colors.size() <= vertex) mesh_.colors.resize(size_t{vertex} + 1, kNoColour);
  if (fits_float(colour[0]) && fits_float(colour[1]) && fits_float(colour[2])) {
    const auto [r, g, b] = to_float(colour);
    mesh_.colors[vertex] = {r, g, b};
  } else {
    ++bad_colours_;
  }
}

void MeshBuilder::set_texture_coordinate(uint32_t vertex, double u, double v_from_below) {
  auto& coordinates = mesh_.texture_coordinates;
  if (coordinates.size() <= vertex) coordinates.resize(size_t{vertex} + 1);
  const double v = 1 - v_from_below;
  if (is_texture_coordinate(u, v)) {
    coordinates[vertex] = {static_cast<float>(u), static_cast<float>(v)};
  } else {
    ++bad_texture_coordinates_;
  }
}

absl::Status MeshBuilder::add_polygon(std::span<const int64_t> corners, Place place) {
  corners_.clear();
  for (int64_t corner : corners) {
    if (corner < 0 || static_cast<uint64_t>(corner) >= mesh_.positions.size()) {
      return source_.malformed(
          fmt::format("vertex index {}", corner), place,
          mesh_.positions.empty() ? "there are no vertices" : fmt::format("must be 0..{}", mesh_.positions.size() - 1));
    }
    if (corners_.empty() || corners_.back() != corner) corners_.push_back(static_cast<uint32_t>(corner));
  }
  while (corners_.size() > 1 && corners_.front() == corners_.back()) corners_.pop_back();
  if (corners_.size() < 3) {
    ++degenerate_;
    return absl::OkStatus();
  }
  if (corners_.size() == 3) return add_triangle(corners_[0], corners_[1], corners_[2]);

  corner_positions_.clear();
  for (uint32_t corner : corners_) corner_positions_.push_back(mesh_.positions[corner]);
  for (const auto& [a, b, c] : splitter_.split(corner_positions_)) {
    const absl::Status status = add_triangle(corners_[a], corners_[b], corners_[c]);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status MeshBuilder::check_corner_count(uint64_t count) const {
  return count <= kMostCorners ? absl::OkStatus() : source_.over_limit("corners of a polygon", count, kMostCorners);
}

absl::Status MeshBuilder::add_triangle(uint32_t a, uint32_t b, uint32_t c) {
  if (a == b || b == c || c == a) {
    ++degenerate_;
    return absl::OkStatus();
  }
  if (++triangles_ > source_.limits.max_triangles) {
    return source_.over_limit("triangles", triangles_, source_.limits.max_triangles);
  }
  mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
  return absl::OkStatus();
}

absl::Status MeshBuilder::end_mesh(std::string_view name) {
  MeshData mesh = std::exchange(mesh_, {});
  if (mesh.triangles.empty()) return absl::OkStatus();
  if (file_.meshes.size() >= source_.limits.max_nodes) {
    return source_.over_limit("meshes", file_.meshes.size() + 1, source_.limits.max_nodes);
  }
  if (!mesh.normals.empty()) mesh.normals.resize(mesh.positions.size());
  if (!mesh.texture_coordinates.empty()) mesh.texture_coordinates.resize(mesh.positions.size());
  if (!mesh.colors.empty()) {
    mesh.colors.resize(mesh.positions.size(), kNoColour);
    make_linear(mesh.colors, colour_coding_);
  }
  mesh.name = tidy_name(name);
  file_.meshes.push_back(std::move(mesh));
  return absl::OkStatus();
}

absl::StatusOr<LoadedFile> MeshBuilder::finish() {
  if (file_.meshes.empty()) return nothing_to_render(source_, vertices_);
  if (degenerate_ > 0) warn(fmt::format("left out: {} faces with fewer than three different corners", degenerate_));
  if (bad_normals_ > 0) warn(fmt::format("left out: {} normals that are not finite or beyond 1e18", bad_normals_));
  if (bad_colours_ > 0) warn(fmt::format("left out: {} colours that are not finite", bad_colours_));
  if (bad_texture_coordinates_ > 0) {
    warn(fmt::format("left out: {} texture coordinates that are not finite or beyond 1e6", bad_texture_coordinates_));
  }
  if (splitter_.fanned() > 0) {
    warn(fmt::format("{} concave polygons were split as fans: self-intersecting or of more than {} corners",
                     splitter_.fanned(), PolygonSplitter::kMostClippedCorners));
  }
  return std::move(file_);
}

absl::Status nothing_to_render(const Source& source, uint64_t vertices, std::string_view why) {
  return source.malformed(fmt::format("nothing to render: it has no triangle (vertices: {})", vertices), why);
}

std::string tidy_name(std::string_view name) {
  size_t length = std::min(name.size(), kLongestName);
  // Not in the middle of a UTF-8 sequence.
  while (length > 0 && length < name.size() && (static_cast<unsigned char>(name[length]) & 0xc0) == 0x80) --length;
  std::string tidy(name.substr(0, length));
  for (char& c : tidy) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return tidy;
}

}  // namespace diaphane::readers

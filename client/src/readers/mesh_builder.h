// Vertices and polygons of a file, gathered into meshes under its limits.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "readers/colour.h"
#include "readers/polygon.h"
#include "readers/source.h"

namespace diaphane::readers {

/// Beyond it, as the contract has it, a normal is refused.
inline constexpr double kLargestNormal = 1e18;

/// Of texture coordinates; the contract takes no larger ones.
inline constexpr double kLargestTextureCoordinate = 1e6;

inline bool is_texture_coordinate(double u, double v) {
  return std::abs(u) <= kLargestTextureCoordinate && std::abs(v) <= kLargestTextureCoordinate;
}

using Double3 = std::array<double, 3>;

/// Builds a file's meshes one after the other. Checks what every format must: finite positions, indices in range, the
/// limits of the source. Not thread-safe; `source` outlives it.
class MeshBuilder {
 public:
  static constexpr uint64_t kMostCorners = 1'000'000;  ///< of one polygon

  explicit MeshBuilder(const Source& source) : source_(source) {}

  /// Makes room for counts that the file's size has been checked against. kResourceExhausted past the limits.
  absl::Status expect(uint64_t vertices, uint64_t triangles);

  /// Positions beyond the range of float are refused as the infinite ones are.
  absl::Status add_vertex(const Double3& position, Place place);

  /// A copy of an earlier vertex, with its colour.
  absl::Status repeat_vertex(uint32_t vertex);

  /// The normal of a vertex, (0, 0, 0) for those without; one that is not finite counts as none.
  void set_normal(uint32_t vertex, const Double3& normal);

  /// The colour of a vertex, as the file codes it; one that is not finite counts as none.
  void set_colour(uint32_t vertex, const Double3& colour);

  /// What set_colour() was given, for the mesh that ends next.
  void code_colours(ColourCoding coding) { colour_coding_ = coding; }

  /// The texture coordinate of a vertex, v counted from below as all formats but glTF do; one that is not finite counts
  /// as none.
  void set_texture_coordinate(uint32_t vertex, double u, double v_from_below);

  /// A polygon of any number of corners; fewer than three different ones in a row and it is dropped.
  absl::Status add_polygon(std::span<const int64_t> corners, Place place);

  /// Whether a polygon may have `count` corners; asked before they are read, because a file may name one vertex for
  /// ever.
  absl::Status check_corner_count(uint64_t count) const;

  uint64_t vertex_count() const { return mesh_.positions.size(); }

  /// Ends the mesh so far under `name`, unless it has no triangle. kResourceExhausted past limits.max_nodes meshes.
  absl::Status end_mesh(std::string_view name);

  /// A line for whoever asked for the file.
  void warn(std::string line) { file_.warnings.push_back(std::move(line)); }

  /// The meshes that were ended. kInvalidArgument when there is none: nothing to render.
  absl::StatusOr<LoadedFile> finish();

 private:
  absl::Status add_triangle(uint32_t a, uint32_t b, uint32_t c);

  const Source& source_;
  LoadedFile file_;
  MeshData mesh_;
  PolygonSplitter splitter_;
  std::vector<uint32_t> corners_;
  std::vector<Vec3> corner_positions_;
  uint64_t vertices_ = 0;
  uint64_t triangles_ = 0;
  uint64_t degenerate_ = 0;
  ColourCoding colour_coding_ = ColourCoding::kLinear;
  uint64_t bad_normals_ = 0;
  uint64_t bad_colours_ = 0;
  uint64_t bad_texture_coordinates_ = 0;
};

/// "nothing to render", in the name of `source`: what a file without a triangle is refused with; `why` may be empty.
absl::Status nothing_to_render(const Source& source, uint64_t vertices, std::string_view why = {});

/// A name from a file, as far as it is fit for a message: at most 120 bytes, without control characters.
std::string tidy_name(std::string_view name);

}  // namespace diaphane::readers

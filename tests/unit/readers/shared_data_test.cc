// The meshes and the malformed files of the data that is shared with the project.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "tests/unit/readers/read_apart.h"

namespace diaphane::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(DIAPHANE_SOURCE_DIR) / ".." / "shared" / "data";

uint64_t triangle_count(const LoadedFile& file) {
  uint64_t count = 0;
  for (const MeshData& mesh : file.meshes) count += mesh.triangles.size() / 3;
  return count;
}

// File → triangles, of the table in the data's README: | `file` | kB | source | licence | tris | ...
std::map<std::string, uint64_t> documented_triangles() {
  std::map<std::string, uint64_t> triangles;
  std::ifstream readme(kData / "README.md");
  for (std::string line; std::getline(readme, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) {
      const size_t begin = cell.find_first_not_of(" `");
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, cell.find_last_not_of(" `") + 1 - begin));
    }
    if (cells.size() < 7 || cells[5].empty() || cells[5].find_first_not_of("0123456789") != std::string::npos) continue;
    if (fs::exists(kData / "meshes" / cells[1])) triangles[cells[1]] = std::stoull(cells[5]);
  }
  return triangles;
}

TEST(SharedMeshes, HaveTheirDocumentedTriangles) {
  if (!fs::exists(kData / "meshes")) GTEST_SKIP() << "no " << kData / "meshes";
  std::map<std::string, uint64_t> expected = documented_triangles();
  ASSERT_GT(expected.size(), 50u);
  // The table counts what meshes are defined, these files place some of them more than once.
  expected["gltf/AttenuationTest.glb"] = 292;
  expected["gltf/BlenderIO_16_volume.glb"] = 296;
  expected["gltf/NegativeScaleTest.glb"] = 7724;
  expected["gltf/RecursiveSkeletons.glb"] = 84 * 76;
  for (const auto& [name, triangles] : expected) {
    const auto file = read_mesh_file(kData / "meshes" / name);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(triangle_count(*file), triangles) << name;
    for (const MeshData& mesh : file->meshes) {
      EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size()) << name;
      EXPECT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size()) << name;
      EXPECT_TRUE(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == mesh.positions.size()) << name;
      EXPECT_LT(*std::max_element(mesh.triangles.begin(), mesh.triangles.end()), mesh.positions.size()) << name;
    }
  }
}

// How many positions, colours and texture coordinates.
std::array<size_t, 3> looks_of(const std::string& name) {
  const auto file = read_mesh_file(kData / "meshes" / name);
  EXPECT_TRUE(file.ok()) << file.status();
  std::array<size_t, 3> counts{};
  if (!file.ok()) return counts;
  for (const MeshData& mesh : file->meshes) {
    counts[0] += mesh.positions.size();
    counts[1] += mesh.colors.size();
    counts[2] += mesh.texture_coordinates.size();
  }
  return counts;
}

TEST(SharedMeshes, KeepTheirColoursAndTextureCoordinates) {
  if (!fs::exists(kData / "meshes")) GTEST_SKIP() << "no " << kData / "meshes";
  const auto [spot, spot_colours, spot_coordinates] = looks_of("spot_quads.obj");
  EXPECT_GT(spot, 188u);  // which are split along the seams of the texture
  EXPECT_EQ(spot_coordinates, spot);
  EXPECT_EQ(spot_colours, 0u);
  const auto [skeletons, skeleton_colours, skeleton_coordinates] = looks_of("gltf/RecursiveSkeletons.glb");
  EXPECT_EQ(skeleton_colours, skeletons);
  EXPECT_EQ(skeleton_coordinates, 0u);
  EXPECT_EQ(looks_of("many_small_holes.ply")[1], looks_of("many_small_holes.ply")[0]);
  EXPECT_EQ(looks_of("gltf/Fox.glb")[2], looks_of("gltf/Fox.glb")[0]);
}

std::string code(absl::StatusCode status) { return absl::StatusCodeToString(status); }

TEST(SharedMalformedFiles, AreReadOrRefusedInOneLine) {
  if (!fs::exists(kData / "malformed")) GTEST_SKIP() << "no " << kData / "malformed";
  std::map<std::string, int> outcomes;
  for (const auto& entry : fs::recursive_directory_iterator(kData / "malformed")) {
    if (!entry.is_regular_file() || entry.path().extension() == ".exr") continue;
    const Outcome outcome = read_apart(entry.path());
    expect_bounded(outcome, entry.path());
    ++outcomes[outcome.line.substr(0, outcome.line.find(':'))];
  }
  for (const auto& [outcome, count] : outcomes) {
    RecordProperty(outcome, count);
    EXPECT_THAT(outcome,
                ::testing::AnyOf("read", code(absl::StatusCode::kInvalidArgument), code(absl::StatusCode::kNotFound),
                                 code(absl::StatusCode::kResourceExhausted), code(absl::StatusCode::kUnimplemented)));
  }
  EXPECT_GT(outcomes["read"], 50);
}

}  // namespace
}  // namespace diaphane::testing

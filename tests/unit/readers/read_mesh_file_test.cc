#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(ReadMeshFile, SaysWhatCannotBeOpened) {
  const ScratchFolder folder;
  const auto missing = read_mesh_file(folder.path() / "none.obj");
  EXPECT_EQ(missing.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(message(missing), EndsWith("none.obj: no such file"));
  EXPECT_EQ(read_mesh_file(folder.write("a", "x") / "b.obj").status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(message(read_mesh_file(folder.path())), HasSubstr("is not a regular file"));
  ASSERT_EQ(mkfifo((folder.path() / "pipe.obj").c_str(), 0600), 0);
  EXPECT_THAT(message(read_mesh_file(folder.path() / "pipe.obj")), HasSubstr("is not a regular file"));
}

TEST(ReadMeshFile, RefusesEmptyAndUnknownFiles) {
  EXPECT_THAT(message(read_bytes("a.obj", "")), HasSubstr("is empty"));
  const auto unknown = read_bytes("a.txt", kTriangle);
  EXPECT_EQ(unknown.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(message(unknown), HasSubstr("is no known kind of mesh file, must be glTF, GLB, OBJ, PLY, STL or OFF"));
}

TEST(ReadMeshFile, KeepsToItsLimits) {
  ReadLimits limits;
  limits.max_file_bytes = sizeof(kTriangle) - 2;
  auto file = read_bytes("a.obj", kTriangle, limits);
  EXPECT_EQ(file.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(message(file), HasSubstr("32 bytes, must be at most 31"));
  limits = {};
  limits.max_vertices = 2;
  EXPECT_THAT(message(read_bytes("a.obj", kTriangle, limits)), HasSubstr("3 vertices, must be at most 2"));
  limits = {};
  limits.max_triangles = 0;
  EXPECT_THAT(message(read_bytes("a.obj", kTriangle, limits)), HasSubstr("1 triangles, must be at most 0"));
}

TEST(ReadMeshFile, CountsCopiesOfVerticesToo) {
  ReadLimits limits;
  limits.max_vertices = 3;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1//2 2//2 3//2\n";
  EXPECT_THAT(message(read_bytes("a.obj", text, limits)), HasSubstr("4 vertices, must be at most 3"));
  limits.max_vertices = 6;
  EXPECT_TRUE(read_bytes("a.obj", text, limits).ok());
}

}  // namespace
}  // namespace diaphane::testing

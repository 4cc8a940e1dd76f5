#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

absl::StatusOr<LoadedFile> read_ply(const std::string& bytes) { return read_bytes("mesh.ply", bytes); }

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + elements + "end_header\n";
}

constexpr char kVertices[] = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
constexpr char kFaces[] = "element face 1\nproperty list uchar int vertex_indices\n";

TEST(PlyReader, ReadsAscii) {
  const auto file =
      read_ply(header("ascii", std::string(kVertices) + kFaces) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 0, 2, 3));
}

// One triangle in rows of mixed types and orders, with normals, colours, other lists and other elements.
std::string mixed_binary(bool big_endian) {
  const auto put = [big_endian](auto value) {
    std::string bytes = raw(value);
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  };
  std::string bytes =
      header(big_endian ? "binary_big_endian" : "binary_little_endian",
             "element vertex 3\nproperty uchar red\nproperty double z\nproperty short y\nproperty int8 x\n"
             "property list ushort float weights\nproperty float nx\nproperty float ny\nproperty float nz\n"
             "element edge 1\nproperty int from\nproperty int to\n"
             "element face 1\nproperty float quality\nproperty list uint ushort vertex_index\n");
  for (int i = 0; i < 3; ++i) {
    bytes +=
        put(uint8_t{200}) + put(double{0.5} * i) + put(static_cast<int16_t>(-300 * i)) + put(static_cast<int8_t>(-i));
    bytes += put(static_cast<uint16_t>(i));
    for (int k = 0; k < i; ++k) bytes += put(1.0f);
    bytes += put(0.0f) + put(0.0f) + put(static_cast<float>(i));
  }
  bytes += put(int32_t{1}) + put(int32_t{2});
  return bytes + put(7.0f) + put(uint32_t{3}) + put(uint16_t{2}) + put(uint16_t{1}) + put(uint16_t{0});
}

TEST(PlyReader, ReadsMixedRowsInEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    const auto file = read_ply(mixed_binary(big_endian));
    ASSERT_TRUE(file.ok()) << file.status();
    const MeshData& mesh = file->meshes[0];
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{-1, -300, 0.5f}, Vec3{-2, -600, 1}));
    EXPECT_THAT(mesh.normals, ElementsAre(Vec3{0, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, 2}));
    EXPECT_THAT(mesh.triangles, ElementsAre(2, 1, 0));
  }
}

constexpr char kRows[] = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";

TEST(PlyReader, ReadsIntegerColoursAsSrgbAndOthersAsLinear) {
  const auto coloured = [](const std::string& type, const std::string& r, const std::string& g, const std::string& b) {
    const std::string properties =
        "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
    const std::string colour = " " + r + " " + g + " " + b + "\n";
    const auto file = read_ply(header("ascii", kRows + properties + kFaces) + "0 0 0" + colour + "1 0 0" + colour +
                               "0 1 0" + colour + "3 0 1 2\n");
    EXPECT_TRUE(file.ok()) << file.status();
    return file.ok() && file->meshes[0].colors.size() == 3 ? file->meshes[0].colors[2] : Rgb{};
  };
  const Rgb from_bytes = coloured("uchar", "255", "188", "0");
  EXPECT_FLOAT_EQ(from_bytes.r, 1);
  EXPECT_NEAR(from_bytes.g, 0.502886, 1e-5);  // IEC 61966-2-1 at 188/255
  EXPECT_NEAR(coloured("ushort", "65535", "48316", "0").g, 0.502886, 1e-4);
  EXPECT_EQ(coloured("float", "0.5", "2", "-1"), (Rgb{0.5f, 1, 0}));
  EXPECT_EQ(coloured("float", "nan", "0", "0"), (Rgb{1, 1, 1}));
}

TEST(PlyReader, ReadsTextureCoordinatesByTheirUsualNames) {
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const auto file =
        read_ply(header("ascii", kRows + std::string("property float ") + u + "\nproperty float " + v + "\n" + kFaces) +
                 "0 0 0 0 1\n1 0 0 0.5 0.25\n0 1 0 inf 0\n3 0 1 2\n");
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_THAT(file->meshes[0].texture_coordinates,
                ElementsAre(TextureCoordinate{0, 0}, TextureCoordinate{0.5f, 0.75f}, TextureCoordinate{}));
    EXPECT_THAT(file->warnings, ElementsAre("left out: 1 texture coordinates that are not finite or beyond 1e6"));
  }
}

TEST(PlyReader, RefusesEveryTruncationOfABinaryFile) {
  const std::string whole = mixed_binary(false);
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(read_ply(whole.substr(0, size)).status().code(), absl::StatusCode::kInvalidArgument) << size;
  }
}

TEST(PlyReader, TakesCarriageReturnsBeforeABinaryBody) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\nproperty char x\r\nproperty char y\r\n"
      "property char z\r\nelement face 1\r\nproperty list uchar uchar vertex_indices\r\nend_header\r\n";
  bytes += std::string("\n\0\0\1\0\0\0\1\0\3\0\1\2", 13);  // the first coordinate looks like a line end
  const auto file = read_ply(bytes);
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].positions[0], (Vec3{10, 0, 0}));
}

TEST(PlyReader, UnrollsStrips) {
  const auto file =
      read_ply(header("ascii", std::string(kVertices) + "element tristrips 1\nproperty list int int vertex_indices\n") +
               "0 0 0 1 0 0 0 1 0 1 1 0 8 0 1 2 3 -1 3 2 1");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2, 2, 1, 3, 3, 2, 1));
}

TEST(PlyReader, RefusesCountsBeforeItAllocates) {
  const std::string four_billion = "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const auto file = read_ply(header(format, four_billion + kFaces) + "0 0 0\n");
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(message(file), HasSubstr("4000000000 of element \"vertex\", in the header, at most"));
  }
  const auto list = read_ply(header("binary_little_endian",
                                    "element vertex 1\nproperty float x\nproperty float y\n"
                                    "property float z\nelement face 1\n"
                                    "property list uint int vertex_indices\n") +
                             std::string(12, '\0') + "\xff\xff\xff\xff");
  EXPECT_THAT(message(list), HasSubstr("a list of 4294967295 \"vertex_indices\""));
  // Rows of nothing take no time, however many there are said to be.
  const auto nothing = read_ply(header("ascii", "element vertex 9223372036854775807\n"));
  EXPECT_THAT(message(nothing), HasSubstr("nothing to render"));
}

struct Refused {
  const char* elements;
  const char* body;
  const char* reason;
};

class PlyRefusal : public ::testing::TestWithParam<Refused> {};

TEST_P(PlyRefusal, NamesTheReason) {
  const auto file = read_ply(header("ascii", GetParam().elements) + GetParam().body);
  EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(message(file), HasSubstr(GetParam().reason));
}

constexpr char kTriangle[] =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\n";

INSTANTIATE_TEST_SUITE_P(
    Ply, PlyRefusal,
    ::testing::Values(
        Refused{kTriangle, "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "vertex index 3, line 14, must be 0..2"},
        Refused{kTriangle, "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "vertex index -2, line 14"},
        Refused{kTriangle, "0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n", "vertex index 0.5, line 14, must be an integer"},
        Refused{kTriangle, "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "a list of -3 \"vertex_indices\""},
        Refused{kTriangle, "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "position 1, 0, inf, line 12, must be finite"},
        Refused{kTriangle, "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "no number for \"z\", line 12"},
        Refused{kTriangle, "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "ends early"},
        Refused{"element vertex 1\nproperty float x\nproperty float y\n", "0 0", "no plain property z"},
        Refused{"element vertex 1\nproperty float x\nproperty float x\n", "", "a second property \"x\", line 6"},
        Refused{"element vertex 1\nelement vertex 1\n", "", "a second element \"vertex\", line 5"},
        Refused{"property float x\n", "", "a property before any element, line 4"},
        Refused{"element vertex 1\nproperty list float int x\n", "", "list count type \"float\", line 5"},
        Refused{"element face 1\nproperty list uchar float vertex_indices\n", "0", "must be a list of an integer type"},
        Refused{"element vertex 0\n", "", "nothing to render"}));

TEST(PlyReader, NamesFacesBeforeVerticesAsAFeature) {
  const auto file = read_ply(header("ascii", std::string(kFaces) + kVertices) + "3 0 1 2 0 0 0 1 0 0 0 1 0 1 1 1");
  EXPECT_EQ(file.status().code(), absl::StatusCode::kUnimplemented);
}

}  // namespace
}  // namespace diaphane::testing

// Files made to hurt: each ends in bounded time and memory, with a mesh or with one line.
#include <gmock/gmock.h>

#include <functional>

#include "tests/unit/readers/gltf_builder.h"
#include "tests/unit/readers/read_apart.h"

namespace diaphane::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

struct Hostile {
  const char* name;  // of the file; its stem names the test
  std::function<std::string()> bytes;
  const char* line;  // what the outcome holds
};

void PrintTo(const Hostile& hostile, std::ostream* out) { *out << hostile.name; }

std::string repeated(std::string_view text, size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string utf16(std::string_view text) {
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += {c, '\0'};
  return wide;
}

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string ply(const std::string& elements, const std::string& body, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

constexpr char kPlyVertices[] = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
constexpr char kPlyRows[] = "0 0 0\n1 0 0\n0 1 0\n";

std::string gltf_text(const std::string& members) { return R"({"asset":{"version":"2.0"},)" + members + "}"; }

// `count` nodes, each the child of the one before.
std::string chain_of_nodes(int count, bool closed) {
  Gltf gltf;
  gltf["nodes"] = json::array();
  for (int i = 0; i + 1 < count; ++i) gltf["nodes"].push_back({{"children", {i + 1}}, {"scale", {2, 2, 2}}});
  gltf["nodes"].push_back({{"mesh", 0}});
  if (closed) gltf["nodes"].back()["children"] = {1};
  gltf["scenes"] = {{{"nodes", {0}}}};
  return gltf.as_glb();
}

// One mesh of a few vertices, morphed by many targets, placed by many nodes.
std::string morph_bomb() {
  Gltf gltf;
  const int vertices = 3000;
  gltf.primitive() = {
      {"attributes", {{"POSITION", gltf.add_accessor(std::string(12 * vertices, '\0'), kFloat, "VEC3", vertices)}}}};
  json targets = json::array(), weights = json::array();
  for (int i = 0; i < 2000; ++i) {
    targets.push_back({{"POSITION", 2}});
    weights.push_back(1);
  }
  gltf.primitive()["targets"] = targets;
  gltf["meshes"][0]["weights"] = weights;
  gltf["nodes"] = json::array();
  for (int i = 0; i < 5000; ++i) gltf["nodes"].push_back({{"mesh", 0}});
  return gltf.as_glb();
}

// The most vertices that instances can make of a small file, with all that a vertex can have.
std::string instance_bomb() {
  Gltf gltf;
  const int vertices = 60'000;
  const std::string zeros(16 * vertices, '\0');
  const auto add = [&](const char* type) { return gltf.add_accessor(zeros, kFloat, type, vertices); };
  gltf.primitive() = {
      {"attributes", {{"POSITION", add("VEC3")}, {"NORMAL", 2}, {"COLOR_0", 2}, {"TEXCOORD_0", add("VEC2")}}},
      {"mode", 5}};
  gltf["nodes"] = json::array();
  for (int i = 0; i < 20'000; ++i) gltf["nodes"].push_back({{"mesh", 0}});
  return gltf.as_glb();
}

std::string skin_bomb() {
  Gltf gltf;
  gltf["nodes"] = {json::object()};
  json joints = json::array();
  for (int i = 0; i < 60'000; ++i) joints.push_back(0);
  gltf["skins"] = {{{"joints", joints}}, {{"joints", joints}}};
  gltf.primitive()["attributes"]["JOINTS_0"] = gltf.add_accessor(std::string(12, '\0'), kUnsignedByte, "VEC4", 3);
  gltf.primitive()["attributes"]["WEIGHTS_0"] = gltf.add_accessor(std::string(48, '\0'), kFloat, "VEC4", 3);
  for (int i = 0; i < 20'000; ++i) gltf["nodes"].push_back({{"mesh", 0}, {"skin", i % 2}});
  return gltf.as_glb();
}

std::string glb_of_chunks(size_t count) {
  const std::string whole = Gltf().as_glb();
  const std::string bytes = whole.substr(12) + repeated(raw(uint32_t{0}) + "JUNK", count);
  return "glTF" + raw(uint32_t{2}) + raw(static_cast<uint32_t>(12 + bytes.size())) + bytes;
}

std::string glb_with(size_t offset, uint32_t lie) { return Gltf().as_glb().replace(offset, 4, raw(lie)); }

std::string gltf_patched(const char* pointer, const json& value) {
  Gltf gltf;
  gltf.patch(pointer, value);
  return gltf.as_glb();
}

std::string gltf_uri(const std::string& uri, uint64_t length) {
  return gltf_text(R"("buffers":[{"byteLength":)" + std::to_string(length) + R"(,"uri":")" + uri + R"("}])");
}

class HostileFile : public ::testing::TestWithParam<Hostile> {};

TEST_P(HostileFile, EndsInBounds) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.write(GetParam().name, GetParam().bytes());
  const Outcome outcome = read_apart(path);
  expect_bounded(outcome, path);
  EXPECT_THAT(outcome.line, HasSubstr(GetParam().line));
}

std::string test_name(const ::testing::TestParamInfo<Hostile>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Obj, HostileFile,
    ::testing::Values(
        Hostile{"utf8_mark.obj", [] { return std::string("\xef\xbb\xbf").append(kTriangle); }, "read"},
        Hostile{"utf16.obj", [] { return utf16(kTriangle); }, "nothing to render"},
        Hostile{"zeros.obj", [] { return std::string(1 << 20, '\0'); }, "nothing to render"},
        Hostile{"long_token.obj", [] { return "v 0 0 " + std::string(50'000'000, '1'); }, "must be finite"},
        Hostile{"long_word.obj", [] { return std::string(50'000'000, 'v'); }, "nothing to render"},
        Hostile{"continued.obj", [] { return std::string(kTriangle) + repeated("\\\n", 10'000'000); }, "read"},
        Hostile{"line_ends.obj", [] { return std::string(kTriangle) + repeated("\r\n\n\r", 10'000'000); }, "read"},
        Hostile{"zigzag.obj",  // a concave polygon of 300,000 corners
                [] {
                  std::string text, face = "f";
                  for (int i = 0; i < 300'000; ++i) {
                    text += "v " + std::to_string(i) + (i % 2 == 0 ? " 0 0\n" : " 1 0\n");
                    face += " " + std::to_string(i + 1);
                  }
                  return text + face + "\n";
                },
                "read"},
        Hostile{"corners.obj", [] { return std::string(kTriangle) + "f" + repeated(" 1 2 3", 500'000); },
                "corners of a polygon, must be at most 1000000"},
        Hostile{"copies.obj",  // every corner is another pair of normal and texture coordinate
                [] {
                  std::string text(kTriangle);
                  text += repeated("vn 0 0 1\nvt 0 0\n", 1000);
                  for (int i = 1; i <= 1000; ++i) {
                    for (int j = 1; j <= 300; ++j) {
                      const std::string pair = "/" + std::to_string(j) + "/" + std::to_string(i);
                      text += "f 1" + pair + " 2" + pair + " 3" + pair + "\n";
                    }
                  }
                  return text;
                },
                "read"},
        Hostile{"relative.obj", [] { return std::string(kTriangle) + "f -1 -2 -9223372036854775808\n"; },
                "vertex index -9223372036854775808, line 5"},
        Hostile{"soup.obj",  // every triangle shares one edge
                [] {
                  std::string text = "v 0 0 0\nv 0 0 1\n";
                  for (int i = 0; i < 100'000; ++i) {
                    text += "v " + std::to_string(i) + " 1 0\nf 1 2 " + std::to_string(i + 3) + "\n";
                  }
                  return text;
                },
                "read"},
        Hostile{"huge_floats.obj", [] { return std::string("v 3e38 0 0\nv -3e38 0 0\nv 0 3e38 0\nf 1 2 3\n"); },
                "read"},
        Hostile{"one_place.obj", [] { return repeated("v 1 1 1\n", 3) + "f 1 2 3\n"; }, "read"}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    Ply, HostileFile,
    ::testing::Values(
        Hostile{"list_2e31.ply",
                [] {
                  return ply(std::string(kPlyVertices) + "element face 1\nproperty list uint uchar vertex_indices\n",
                             std::string(36, '\0') + raw(uint32_t{1} << 31) + std::string(1000, '\1'),
                             "binary_little_endian");
                },
                "a list of 2147483648"},
        Hostile{"negative_list.ply",
                [] {
                  return ply(std::string(kPlyVertices) + "element face 1\nproperty list int uchar vertex_indices\n",
                             std::string(36, '\0') + raw(int32_t{-5}) + "12345", "binary_little_endian");
                },
                "a list of -5"},
        Hostile{"elements.ply",
                [] {
                  std::string elements;
                  for (int i = 0; i < 1'000'000; ++i) elements += "element e" + std::to_string(i) + " 0\n";
                  return ply(elements, "");
                },
                "101 elements, must be at most 100"},
        Hostile{"comments.ply", [] { return ply(repeated("comment c\n", 3'000'000), ""); }, "nothing to render"},
        Hostile{"wide_rows.ply",
                [] {
                  std::string elements = "element row 2000000\n";
                  for (int i = 0; i < 900; ++i) elements += "property list uchar float p" + std::to_string(i) + "\n";
                  return ply(elements + kPlyVertices, kPlyRows, "binary_big_endian");
                },
                "2000000 of element \"row\", in the header, at most"},
        Hostile{"empty_rows.ply",
                [] { return ply(std::string("element nothing 9000000000000000000\n") + kPlyVertices, kPlyRows); },
                "nothing to render"},
        Hostile{"no_newline.ply", [] { return "ply\n" + std::string(30'000'000, 'x'); }, "ends within the header"},
        Hostile{"nan.ply",
                [] {
                  return ply(std::string(kPlyVertices) + "element face 1\nproperty list uchar int vertex_indices\n",
                             "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n");
                },
                "must be finite"}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    OffAndStl, HostileFile,
    ::testing::Values(
        Hostile{"no_counts.off", [] { return std::string("OFF\n"); }, "ends before its counts"},
        Hostile{"words_for_counts.off", [] { return std::string("OFF\nthree one 0\n"); },
                "count of vertices \"three\""},
        Hostile{"blank.off", [] { return "OFF\n" + repeated("# nothing\n\n", 3'000'000); }, "ends before its counts"},
        Hostile{"counts_2e63.off", [] { return std::string("OFF\n9223372036854775807 9223372036854775807 0\n"); },
                "cannot be in"},
        Hostile{"long_face.off", [] { return "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000" + repeated(" 0", 2'000'000); },
                "2000000 corners of a polygon"},
        Hostile{"count_lies.stl",
                [] { return std::string(80, ' ') + raw(uint32_t{0xffffffff}) + std::string(5000, 'x'); },
                "4294967295 triangles, byte 80, there is room for 100"},
        Hostile{"count_is_less.stl", [] { return std::string(80, ' ') + raw(uint32_t{1}) + std::string(5000, '\0'); },
                "nothing to render"},
        Hostile{"solids.stl", [] { return "solid\nfacet\nendfacet\n" + repeated("solid x\nendsolid x\n", 1'000'000); },
                "a facet of 0 vertices ends"},
        Hostile{"many_solids.stl",
                [] {
                  return repeated(
                      "solid\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n",
                      150'000);
                },
                "100001 meshes, must be at most 100000"},
        Hostile{"vertices.stl", [] { return "solid\nfacet\n" + repeated("vertex 0 0 0\n", 1'500'000); },
                "corners of a polygon, must be at most"}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    Gltf, HostileFile,
    ::testing::Values(
        Hostile{"utf16.gltf", [] { return utf16(gltf_text(R"("nodes":[])")); }, "is neither a JSON object nor GLB"},
        Hostile{"utf8_mark.gltf", [] { return std::string("\xef\xbb\xbf") + gltf_text(R"("nodes":[])"); },
                "nothing to render"},
        Hostile{"deep.gltf", [] { return gltf_text(R"("nodes":)" + std::string(5'000'000, '[')); }, "levels of JSON"},
        Hostile{"own_child.glb", [] { return gltf_patched("/nodes/0/children", {0}); }, "nothing to render"},
        Hostile{"own_child_in_scene.glb",
                [] {
                  Gltf gltf;
                  gltf["nodes"][0]["children"] = {0};
                  gltf["scenes"] = {{{"nodes", {0}}}};
                  return gltf.as_glb();
                },
                "is reached twice, node 0"},
        Hostile{"chain.glb", [] { return chain_of_nodes(90'000, false); }, "a transform that is not finite"},
        Hostile{"short_chain.glb", [] { return chain_of_nodes(100, false); }, "read"},
        Hostile{"cycle.glb", [] { return chain_of_nodes(90'000, true); }, "node"},
        Hostile{"morphs.glb", morph_bomb, "too many accessor elements"},
        Hostile{"instances.glb", instance_bomb, "must be at most"},
        Hostile{"skins.glb", skin_bomb, "too many accessor elements"},
        Hostile{"chunks.glb", [] { return glb_of_chunks(2'000'000); }, "read"},
        Hostile{"length_lies.glb", [] { return glb_with(8, 0xffffffff); }, "GLB length 4294967295"},
        Hostile{"length_is_short.glb", [] { return glb_with(8, 13); }, "ends within a GLB chunk header"},
        Hostile{"chunk_lies.glb", [] { return glb_with(12, 0xfffffff0); }, "GLB chunk of 4294967280 bytes"},
        Hostile{"data_uri.gltf",
                [] { return gltf_uri("data:application/octet-stream;base64," + std::string(40'000'000, 'A'), 1); },
                "nothing to render"},
        Hostile{"data_uri_lies.gltf",
                [] { return gltf_uri("data:application/octet-stream;base64,AAAA", 2'000'000'000); },
                "byteLength 2000000000, buffer 0, there are 3 bytes"},
        Hostile{"four_gigabytes.gltf", [] { return gltf_uri("data:application/octet-stream;base64,AAAA", 4294967296); },
                "byteLength of the wrong type"},
        Hostile{"itself.gltf", [] { return gltf_uri("itself.gltf", 1); }, "nothing to render"},
        Hostile{"folder.gltf", [] { return gltf_uri(".", 1); }, "is not a regular file"},
        Hostile{"above.gltf", [] { return gltf_uri("../../../etc/passwd", 1); }, "own folder"},
        Hostile{"count.glb", [] { return gltf_patched("/accessors/0/count", 2147483647); }, "vertices or more"},
        Hostile{"indices.glb", [] { return gltf_patched("/accessors/1/count", 2147483647); }, "triangles or more"},
        Hostile{"stride.glb", [] { return gltf_patched("/bufferViews/0/byteStride", 2147483644); }, "`byteStride'"},
        Hostile{"huge_scale.glb",
                [] {
                  return gltf_patched("/nodes/0/scale", {3e38, 3e38, 3e38});
                },
                "read"},
        Hostile{"tiny_scale.glb",
                [] {
                  return gltf_patched("/nodes/0/scale", {1e-300, 1, 1});
                },
                "read"}),
    test_name);

TEST(HostilePath, IsNoRegularFile) {
  for (const char* path : {"/dev/zero", "/dev/null", "/dev/tty", "/proc/self/mem", "/proc/self"}) {
    const Outcome outcome = read_apart(path);
    expect_bounded(outcome, path);
    EXPECT_NE(outcome.line, "read") << path;
  }
  const ScratchFolder folder;
  std::filesystem::create_symlink("loop.obj", folder.path() / "loop.obj");
  std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.obj");
  for (const char* name : {"loop.obj", "zero.obj"}) {
    const Outcome outcome = read_apart(folder.path() / name);
    expect_bounded(outcome, folder.path() / name);
    EXPECT_NE(outcome.line, "read") << name;
  }
}

}  // namespace
}  // namespace diaphane::testing

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/unit/readers/gltf_builder.h"

namespace diaphane::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(GltfReader, ReadsAGlbInMetres) {
  Gltf gltf;
  gltf["meshes"][0]["name"] = "wedge";
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(1));
  EXPECT_EQ(file->meshes[0].name, "wedge");
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}));
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_EQ(file->meshes[0].scene_from_mesh, MeshData().scene_from_mesh);
  EXPECT_EQ(file->millimetres_per_unit, 1000);
}

TEST(GltfReader, ReadsDataUrisAndFilesOfItsFolder) {
  const char* json_format = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"%s"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}]})";
  const auto with_uri = [&](const std::string& uri) {
    std::string text(json_format);
    return text.replace(text.find("%s"), 2, uri);
  };
  const ScratchFolder folder;
  folder.write("parts/two words.bin", Gltf::positions({0, 0, 0, 1, 0, 0, 0, 1, 0}) + "slack");
  const auto from_file = read_mesh_file(folder.write("a.gltf", with_uri("parts/two%20words.bin")));
  ASSERT_TRUE(from_file.ok()) << from_file.status();
  EXPECT_EQ(from_file->meshes[0].positions[1], (Vec3{1, 0, 0}));
  const auto from_data = read_mesh_file(folder.write(
      "b.gltf", with_uri("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")));
  ASSERT_TRUE(from_data.ok()) << from_data.status();
  EXPECT_EQ(from_data->meshes[0].positions[2], (Vec3{0, 1, 0}));
}

TEST(GltfReader, OpensNothingOutsideItsFolder) {
  const ScratchFolder folder;
  const auto secret = folder.write("secret.bin", std::string(36, '\0'));
  folder.write("inside/here.bin", std::string(36, '\0'));
  std::filesystem::create_symlink(secret, folder.path() / "inside" / "link.bin");
  std::filesystem::create_symlink(folder.path(), folder.path() / "inside" / "up");
  std::filesystem::create_symlink("here.bin", folder.path() / "inside" / "alias.bin");
  const auto read_uri = [&](const std::string& uri) {
    Gltf gltf;
    gltf["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    gltf.primitive().erase("indices");
    return read_mesh_file(folder.write("inside/scene.glb", gltf.as_glb()));
  };
  EXPECT_TRUE(read_uri("here.bin").ok());
  EXPECT_TRUE(read_uri("alias.bin").ok());
  for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "x/../../secret.bin", "link.bin", "up/secret.bin",
                          "file:///etc/passwd", "/etc/passwd", "..\\secret.bin", "here.bin%00", "%zz", ""}) {
    const auto file = read_uri(uri);
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << uri << ": " << file.status();
    EXPECT_THAT(message(file), HasSubstr("own folder")) << uri;
  }
  EXPECT_EQ(read_uri(secret.string()).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(read_uri("missing.bin").status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(message(read_uri("up")), HasSubstr("own folder"));
}

TEST(GltfReader, PlacesOneMeshPerInstanceThroughTheTree) {
  Gltf gltf;
  gltf["nodes"] = json::parse(R"([{"name":"a","mesh":0,"translation":[1,2,3],"scale":[2,-2,2],"children":[1]},
      {"mesh":0,"rotation":[0,0,0.70710678,0.70710678]},{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1]},
      {"mesh":0,"scale":[0,0,0]}])");
  gltf["scenes"] = {{{"nodes", {2, 0, 3}}}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_THAT(file->meshes, SizeIs(3));
  EXPECT_THAT(file->meshes[0].scene_from_mesh, ElementsAre(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1));
  EXPECT_EQ(file->meshes[1].name, "a");
  EXPECT_THAT(file->meshes[1].scene_from_mesh, ElementsAre(2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1));
  const std::array<float, 16> turned = {0, -2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1};
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(file->meshes[2].scene_from_mesh[i], turned[i], 1e-6) << i;
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr("1 primitives of no volume")));
}

TEST(GltfReader, RefusesCyclesAndSharedChildren) {
  for (const char* nodes :
       {R"([{"mesh":0,"children":[1]},{"children":[2]},{"children":[0]}])", R"([{"mesh":0,"children":[0]}])",
        R"([{"mesh":0,"children":[1,2]},{"children":[2]},{}])", R"([{"mesh":0,"children":[1,1]},{}])"}) {
    Gltf gltf;
    gltf["nodes"] = json::parse(nodes);
    gltf["scenes"] = {{{"nodes", {0}}}};
    EXPECT_THAT(message(gltf.read()), HasSubstr("the nodes must be a tree")) << nodes;
  }
}

TEST(GltfReader, WalksDeepChains) {
  Gltf gltf;
  for (int i = 0; i < 50'000; ++i) {
    gltf["nodes"][static_cast<size_t>(i)] = {{"children", {i + 1}}, {"translation", {0, 0, 1}}};
  }
  gltf["nodes"][50'000] = {{"mesh", 0}};
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].scene_from_mesh[14], 50'000);
}

TEST(GltfReader, UnrollsStripsAndFans) {
  const std::string square = Gltf::positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  for (const auto& [mode, triangles] :
       {std::pair{5, std::vector<uint32_t>{0, 1, 2, 1, 3, 2}}, {6, {1, 2, 0, 2, 3, 0}}}) {
    Gltf gltf;
    gltf.primitive() = {{"attributes", {{"POSITION", gltf.add_accessor(square, kFloat, "VEC3", 4)}}}, {"mode", mode}};
    const auto file = gltf.read();
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->meshes[0].triangles, triangles) << mode;
  }
}

TEST(GltfReader, LeavesPointsAndLinesOutWithAWarning) {
  Gltf gltf;
  gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes, SizeIs(1));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 primitives of points or lines"));
  gltf.primitive()["mode"] = 0;
  EXPECT_THAT(message(gltf.read()), HasSubstr("nothing to render: it has no triangle (vertices: 0), left out: 2 "));
  gltf.primitive()["mode"] = 7;
  EXPECT_THAT(message(gltf.read()), HasSubstr("mode 7, mesh 0 primitive 0, must be 0..6"));
}

TEST(GltfReader, ScalesQuantisedAccessors) {
  Gltf gltf;
  std::string bytes;
  for (int8_t v : {-128, 127, 0, 0 /* padding to the stride */, 64, -127, 1, 0, 0, 0, 0, 0}) bytes += raw(v);
  const int position = gltf.add_accessor(bytes, kByte, "VEC3", 3, true);
  gltf["bufferViews"][2]["byteStride"] = 4;
  gltf.primitive()["attributes"]["POSITION"] = position;
  gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
  auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{-1, 1, 0}, Vec3{64 / 127.0f, -1, 1 / 127.0f}, Vec3{0, 0, 0}));
  gltf.accessor(2)["normalized"] = false;
  gltf.accessor(2)["componentType"] = kUnsignedByte;
  file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].positions, ElementsAre(Vec3{128, 127, 0}, Vec3{64, 129, 1}, Vec3{0, 0, 0}));
}

// Positions of which number 2 is replaced, with or without a base.
Gltf sparse_gltf(bool with_base) {
  Gltf gltf;
  const int indices = gltf.add_view(raw(uint16_t{2}) + raw(uint16_t{0}));
  const int values = gltf.add_view(Gltf::positions({5, 6, 7}));
  gltf.accessor(0)["sparse"] = {{"count", 1},
                                {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                                {"values", {{"bufferView", values}}}};
  if (!with_base) gltf.accessor(0).erase("bufferView");
  return gltf;
}

TEST(GltfReader, AppliesSparseAccessors) {
  const auto over_base = sparse_gltf(true).read();
  ASSERT_TRUE(over_base.ok()) << over_base.status();
  EXPECT_THAT(over_base->meshes[0].positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{5, 6, 7}));
  const auto over_zeros = sparse_gltf(false).read();
  ASSERT_TRUE(over_zeros.ok()) << over_zeros.status();
  EXPECT_THAT(over_zeros->meshes[0].positions, ElementsAre(Vec3{}, Vec3{}, Vec3{5, 6, 7}));
}

TEST(GltfReader, RefusesSparseAccessorsThatReachOut) {
  for (const auto& [pointer, value, reason] : {std::tuple{"/count", 4, "sparse count 4, accessor 0, must be 1..3"},
                                               {"/count", -1, "sparse count -1"},
                                               {"/count", 2, "elements of 12 bytes"},
                                               {"/indices/bufferView", 9, "bufferView 9, accessor 0, there are 4"},
                                               {"/indices/byteOffset", -4, "sparse offsets"},
                                               {"/indices/componentType", kShort, "index type"},
                                               {"/indices/byteOffset", 4, "bufferView 2 has 0 bytes"},
                                               {"/values/byteOffset", 2147483647, "has 0 bytes"}}) {
    Gltf gltf = sparse_gltf(true);
    gltf.accessor(0)["sparse"][json::json_pointer(pointer)] = value;
    const auto file = gltf.read();
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << pointer;
    EXPECT_THAT(message(file), HasSubstr(reason)) << pointer;
  }
  Gltf gltf;
  gltf.accessor(0)["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", gltf.add_view(raw(uint16_t{3}))}, {"componentType", kUnsignedShort}}},
      {"values", {{"bufferView", 0}}}};
  EXPECT_THAT(message(gltf.read()), HasSubstr("sparse index 3, accessor 0, must be 0..2"));
}

TEST(GltfReader, AppliesDefaultMorphWeightsOfNodeBeforeMesh) {
  Gltf gltf;
  gltf.primitive()["targets"] = {
      {{"POSITION", gltf.add_accessor(Gltf::positions({0, 0, 2, 0, 0, 2, 0, 0, 2}), kFloat, "VEC3", 3)}},
      {{"POSITION", gltf.add_accessor(Gltf::positions({4, 0, 0, 4, 0, 0, 4, 0, 0}), kFloat, "VEC3", 3)}}};
  auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].positions[0], (Vec3{0, 0, 0}));
  gltf["meshes"][0]["weights"] = {0.5, 1};
  file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].positions[1], (Vec3{5, 0, 1}));
  gltf["nodes"][0]["weights"] = {0, 0.25};
  file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].positions[1], (Vec3{2, 0, 0}));
  gltf["nodes"][0]["weights"] = {1e39, 0};
  EXPECT_THAT(message(gltf.read()), HasSubstr("mesh 0 primitive 0, must be finite"));
}

TEST(GltfReader, ReadsNormals) {
  Gltf gltf;
  gltf.primitive()["attributes"]["NORMAL"] =
      gltf.add_accessor(Gltf::positions({0, 0, 1, 0, 0, 1, NAN, 0, 1}), kFloat, "VEC3", 3);
  auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].normals, ElementsAre(Vec3{0, 0, 1}, Vec3{0, 0, 1}, Vec3{0, 0, 0}));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 normals that are not finite or beyond 1e18"));
  gltf.accessor(2)["count"] = 2;
  EXPECT_THAT(message(gltf.read()), HasSubstr("2 elements, accessor 2, must be 3"));
}

TEST(GltfReader, ReadsColoursOfEveryForm) {
  const std::string bytes("\xff\x33\x00\xff\xff\x33\x00\xff\xff\x33\x00\xff", 12);
  const std::string shorts = raw(uint16_t{65535}) + raw(uint16_t{13107}) + raw(uint16_t{0}) + raw(uint16_t{0});
  for (const bool alpha : {false, true}) {
    Gltf floats;
    floats.primitive()["attributes"]["COLOR_0"] =
        alpha ? floats.add_accessor(Gltf::positions({1, 0.2f, 0, 1, 1, 0.2f, 0, 1, 1, 0.2f, 0, 1}), kFloat, "VEC4", 3)
              : floats.add_accessor(Gltf::positions({1, 0.2f, 0, 1, 0.2f, 0, 2, 0.2f, -1}), kFloat, "VEC3", 3);
    const auto file = floats.read();
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_THAT(file->meshes[0].colors, ElementsAre(Rgb{1, 0.2f, 0}, Rgb{1, 0.2f, 0}, Rgb{1, 0.2f, 0})) << alpha;
  }
  const auto read = [](const std::string& colours, int component, bool normalized) {
    Gltf gltf;
    gltf.primitive()["attributes"]["COLOR_0"] = gltf.add_accessor(colours, component, "VEC4", 3, normalized);
    return gltf.read();
  };
  EXPECT_EQ(read(bytes, kUnsignedByte, true)->meshes[0].colors.at(2), (Rgb{1, 0.2f, 0}));
  EXPECT_EQ(read(shorts + shorts + shorts, kUnsignedShort, true)->meshes[0].colors.at(1), (Rgb{1, 0.2f, 0}));
  EXPECT_THAT(message(read(bytes, kUnsignedByte, false)),
              HasSubstr("accessor 2, must be VEC3 or VEC4 of floats or of normalised"));
}

TEST(GltfReader, ReadsTextureCoordinatesAsTheyAre) {
  Gltf gltf;
  gltf.primitive()["attributes"]["TEXCOORD_0"] =
      gltf.add_accessor(Gltf::positions({0, 0, 0.25f, 2, NAN, 1}), kFloat, "VEC2", 3);
  auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].texture_coordinates,
              ElementsAre(TextureCoordinate{}, TextureCoordinate{0.25f, 2}, TextureCoordinate{}));
  EXPECT_THAT(file->warnings, ElementsAre("left out: 1 texture coordinates that are not finite or beyond 1e6"));
  gltf.accessor(2)["count"] = 2;
  EXPECT_THAT(message(gltf.read()), HasSubstr("2 elements, accessor 2, must be 3"));
}

struct Patch {
  const char* pointer;
  const char* value;  // JSON
  const char* reason;
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};

class GltfRefusal : public ::testing::TestWithParam<Patch> {};

TEST_P(GltfRefusal, NamesTheReason) {
  Gltf gltf;
  gltf["buffers"] = {{{"byteLength", 42}}};
  gltf.patch(GetParam().pointer, json::parse(GetParam().value));
  const auto file = gltf.read();
  EXPECT_EQ(file.status().code(), GetParam().code) << file.status();
  EXPECT_THAT(message(file), HasSubstr(GetParam().reason));
}

constexpr auto kUnknownFeature = absl::StatusCode::kUnimplemented;

INSTANTIATE_TEST_SUITE_P(
    Gltf, GltfRefusal,
    ::testing::Values(
        Patch{"/asset/version", "\"1.0\"", "glTF 1 cannot be read", kUnknownFeature},
        Patch{"/asset", "{}", "asset.version is missing"},
        Patch{"/extensionsRequired", "[\"KHR_of_later_days\"]",
              "required extension \"KHR_of_later_days\" cannot be read", kUnknownFeature},
        Patch{"/extensionsRequired", "[7]", "required extension \"\"", kUnknownFeature},
        Patch{"/nodes", "3", "nodes is not an array"}, Patch{"/nodes/0/mesh", "1", "mesh 1, node 0, there are 1"},
        Patch{"/nodes/0/children", "[0]", "nothing to render"},
        Patch{"/scenes", "[{\"nodes\":[0,0]}]", "is reached twice, node 0, the nodes must be a tree"},
        Patch{"/scenes", "[{\"nodes\":[1]}]", "node 1, there are 1"}, Patch{"/scenes", "[]", "", absl::StatusCode::kOk},
        Patch{"/nodes/0/matrix", "[1,0,0]", "a transform of the wrong length, node 0"},
        Patch{"/nodes/0/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]", "not affine, node 0"},
        Patch{"/nodes/0/scale", "[1e300,1e300,1e300]", "a transform that is not finite, node 0"},
        Patch{"/nodes/0/rotation", "[0,0,0,0]", "a rotation of length 0, node 0"},
        Patch{"/nodes/0/translation", "[1,2,\"3\"]",
              "translation of the wrong type, nodes 0, must be an array of numbers"},
        Patch{"/accessors/0/count", "4", "4 elements of 12 bytes, 12 apart, accessor 0, bufferView 0 has 36 bytes"},
        Patch{"/accessors/0/count", "18446744073709551615",
              "count of the wrong type, accessors 0, must be an integer of 32 bits"},
        Patch{"/accessors/0/byteOffset", "40", "accessor 0, bufferView 0 has 0 bytes"},
        Patch{"/accessors/0/bufferView", "2", "bufferView 2, accessor 0, there are 2"},
        Patch{"/accessors/0/type", "\"VEC4\"", "accessor 0, must be VEC3"},
        Patch{"/accessors/0/componentType", "5125", "accessor 0, must be VEC3"},
        Patch{"/accessors/1/componentType", "5122", "indices must be SCALAR of unsigned integers"},
        Patch{"/bufferViews/0/byteLength", "43", "bytes 0 + 43 of bufferView 0, accessor 0, the buffer has 42"},
        Patch{"/bufferViews/0/byteOffset", "2147483647", "of bufferView 0, accessor 0, the buffer has 42"},
        Patch{"/bufferViews/0/buffer", "-1", "buffer -1 of bufferView 0"},
        Patch{"/bufferViews/0/byteStride", "4", "byteStride 4 of bufferView 0, accessor 0, must be at least 12"},
        Patch{"/bufferViews/0/byteStride", "16", "16 apart"},
        Patch{"/buffers/0/byteLength", "4000000000",
              "byteLength of the wrong type, buffers 0, must be an integer of 32 bits"},
        Patch{"/buffers/0/uri", "7", "uri is no string, buffer 0"},
        Patch{"/buffers/1", "{\"byteLength\":42}", "no uri and no binary chunk, buffer 1"},
        Patch{"/meshes/0/primitives/0/attributes/POSITION", "-3", "accessor -3, there are 2"},
        Patch{"/meshes/0/primitives/0/attributes", "[]", "attributes of the wrong type, meshes 0, must be an object"},
        Patch{"/accessors/0/count", "-3", "is not glTF 2.0: 'count' property is not a positive integer"},
        Patch{"/meshes/0/primitives/0/indices", "0", "indices must be SCALAR"},
        Patch{"/meshes/0/primitives/0/indices", "4294967297", "indices of the wrong type, meshes 0"},
        Patch{"/meshes/0/primitives/0/mode", "4.5", "mode of the wrong type, meshes 0"},
        Patch{"/meshes/0/primitives/0/targets", "[{\"POSITION\":true}]", "POSITION of the wrong type, meshes 0"},
        Patch{"/meshes/0/primitives/1", "7", "primitives of the wrong type, meshes 0, must be an array of objects"},
        Patch{"/scene", "\"0\"", "scene of the wrong type"}));

TEST(GltfReader, RefusesIndicesPastTheVertices) {
  Gltf gltf;
  gltf.primitive()["indices"] =
      gltf.add_accessor(raw(uint32_t{0}) + raw(uint32_t{1}) + raw(uint32_t{3}), 5125, "SCALAR", 3);
  EXPECT_THAT(message(gltf.read()), HasSubstr("index 2 is 3, mesh 0 primitive 0, must be 0..2"));
}

TEST(GltfReader, RefusesNumbersThatAreNotFinite) {
  Gltf gltf;
  gltf.primitive()["attributes"]["POSITION"] =
      gltf.add_accessor(Gltf::positions({0, 0, 0, 1, INFINITY, 0, 0, 1, 0}), kFloat, "VEC3", 3);
  EXPECT_THAT(message(gltf.read()), HasSubstr("position 1 is 1, inf, 0, mesh 0 primitive 0, must be finite"));
  EXPECT_THAT(message(read_bytes("a.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"scale":[1e999,1,1]}]})")),
              HasSubstr("a JSON number that is out of range, byte "));
}

TEST(GltfReader, BoundsWhatInstancesMultiply) {
  ReadLimits limits;
  limits.max_nodes = 50;
  Gltf gltf;
  for (int i = 0; i < 49; ++i) gltf["nodes"].push_back({{"mesh", 0}});
  EXPECT_TRUE(gltf.read(limits).ok());
  limits.max_vertices = 149;
  EXPECT_THAT(message(gltf.read(limits)), HasSubstr("150 vertices or more, must be at most 149"));
  limits.max_vertices = 150;
  limits.max_triangles = 49;
  EXPECT_THAT(message(gltf.read(limits)), HasSubstr("50 triangles or more, must be at most 49"));
  limits.max_triangles = 50;
  gltf["meshes"][0]["primitives"].push_back(gltf.primitive());
  EXPECT_THAT(message(gltf.read(limits)), HasSubstr("51 primitives placed by nodes, must be at most 50"));
  gltf["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(gltf.read(limits).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(message(gltf.read(limits)), HasSubstr("51 nodes, must be at most 50"));
}

TEST(GltfReader, StopsAtDeepAndAtManyJsonValues) {
  const std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100000, '[');
  EXPECT_THAT(message(read_bytes("deep.gltf", deep)), HasSubstr("65 levels of JSON or more, must be at most 64"));
  std::string many = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
  for (int i = 0; i < 3000; ++i) many += ",{}";
  ReadLimits limits;
  limits.max_nodes = 100;
  const auto file = read_bytes("many.gltf", many + "]}", limits);
  EXPECT_EQ(file.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(message(file), HasSubstr("2001 JSON objects or more, must be at most 2000"));
}

TEST(GltfReader, LooksAtNothingThatItDoesNotNeed) {
  Gltf gltf;
  gltf["materials"] = 3;
  gltf["images"] = {{{"uri", "/etc/passwd"}}, {{"bufferView", 99}}};
  gltf["animations"] = {{{"channels", "none"}}};
  gltf["skins"] = {{{"joints", {99}}}};
  gltf["extras"] = {{"nodes", 3}};
  gltf["nodes"][0]["extras"] = {{"mesh", 99}};
  gltf["nodes"][0]["skin"] = 0;
  gltf["nodes"][0]["extensions"] = {{"EXT_x", {{"extras", json::array({json::array({1})})}}}};
  gltf.accessor(0)["min"] = {0, 0, 0};
  EXPECT_TRUE(gltf.read().ok()) << gltf.read().status();
}

TEST(GltfReader, RefusesEveryTruncationOfAGlb) {
  const std::string whole = Gltf().as_glb();
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(read_bytes("cut.glb", whole.substr(0, size)).status().code(), absl::StatusCode::kInvalidArgument) << size;
  }
}

}  // namespace
}  // namespace diaphane::testing

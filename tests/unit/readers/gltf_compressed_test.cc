// glTF that Draco or meshoptimizer compressed, by the libraries' own encoders.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <memory>

#include "draco/compression/encode.h"
#include "draco/mesh/triangle_soup_mesh_builder.h"
#include "meshoptimizer.h"
#include "tests/unit/readers/gltf_builder.h"

namespace diaphane::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr uint32_t kSide = 9;  // vertices along an edge of the grid
constexpr uint32_t kVertices = kSide * kSide;
constexpr uint32_t kTriangles = 2 * (kSide - 1) * (kSide - 1);
constexpr int kUnsignedInt = 5125;

// A wavy sheet; its texture coordinates are its x and y, its colours show a seam in the middle.
struct Sheet {
  std::vector<Vec3> positions;
  std::vector<uint32_t> triangles;
};

Sheet sheet() {
  Sheet made;
  for (uint32_t v = 0; v < kVertices; ++v) {
    const auto x = static_cast<float>(v % kSide), y = static_cast<float>(v / kSide);
    made.positions.push_back({x, y, 0.25f * static_cast<float>((v * 7) % 5)});
  }
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t v = y * kSide + x;
      made.triangles.insert(made.triangles.end(), {v, v + 1, v + kSide, v + 1, v + kSide + 1, v + kSide});
    }
  }
  return made;
}

// Each triangle's corners from the smallest on, sorted: equal for the same surface in whatever order.
std::vector<std::array<float, 9>> surface(const std::vector<Vec3>& positions, const std::vector<uint32_t>& triangles) {
  std::vector<std::array<float, 9>> result;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    std::array<std::array<float, 3>, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = positions[triangles[t + k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> flat;
    for (size_t i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
    result.push_back(flat);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string draco_bytes(int method) {
  const Sheet made = sheet();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(kTriangles);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int texture = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  for (uint32_t t = 0; t < kTriangles; ++t) {
    std::array<Vec3, 3> p;
    std::array<std::array<float, 2>, 3> uv;
    for (size_t k = 0; k < 3; ++k) {
      p[k] = made.positions[made.triangles[3 * t + k]];
      uv[k] = {p[k].x, p[k].y};
    }
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(t), &p[0], &p[1], &p[2]);
    builder.SetAttributeValuesForFace(texture, draco::FaceIndex(t), &uv[0], &uv[1], &uv[2]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  EXPECT_EQ(mesh->num_points(), kVertices);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

// Attribute 0 of the compressed bytes is the position, 1 the texture coordinate; the accessors have no bytes.
Gltf draco_gltf(const std::string& compressed) {
  Gltf gltf;
  gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  gltf["accessors"] = {{{"componentType", kFloat}, {"type", "VEC3"}, {"count", kVertices}},
                       {{"componentType", kUnsignedShort}, {"type", "SCALAR"}, {"count", 3 * kTriangles}},
                       {{"componentType", kFloat}, {"type", "VEC2"}, {"count", kVertices}}};
  gltf.primitive() = {{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}};
  gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", gltf.add_view(compressed)},
                                                                  {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
  return gltf;
}

class DracoMethods : public ::testing::TestWithParam<int> {};

TEST_P(DracoMethods, DecodeToTheSameSurface) {
  const auto file = draco_gltf(draco_bytes(GetParam())).read();
  ASSERT_TRUE(file.ok()) << file.status();
  const MeshData& mesh = file->meshes[0];
  const Sheet made = sheet();
  EXPECT_EQ(surface(mesh.positions, mesh.triangles), surface(made.positions, made.triangles));
  ASSERT_THAT(mesh.texture_coordinates, SizeIs(kVertices));
  for (size_t i = 0; i < kVertices; ++i) {
    EXPECT_EQ(mesh.texture_coordinates[i], (TextureCoordinate{mesh.positions[i].x, mesh.positions[i].y}));
  }
}

TEST_P(DracoMethods, RefuseCountsOtherThanTheAccessors) {
  for (const auto& [pointer, count] : {std::pair{"/accessors/0/count", kVertices - 1},
                                       {"/accessors/0/count", kVertices + 1},
                                       {"/accessors/0/count", 3'999'999u},
                                       {"/accessors/1/count", 3 * kTriangles - 3},
                                       {"/accessors/1/count", 3 * kTriangles + 3}}) {
    Gltf gltf = draco_gltf(draco_bytes(GetParam()));
    gltf.patch(pointer, count);
    const auto file = gltf.read();
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << pointer << " " << count;
    EXPECT_THAT(message(file), HasSubstr("Draco cannot be decoded, mesh 0 primitive 0, must hold")) << count;
  }
}

// What begins with the whole of its connectivity may lack the end of its last attribute and still decode.
TEST_P(DracoMethods, ReadOrRefuseEveryTruncation) {
  const std::string whole = draco_bytes(GetParam());
  size_t refused = 0;
  for (size_t size = 0; size < whole.size(); ++size) {
    const auto file = draco_gltf(whole.substr(0, size) + (size == 0 ? "x" : "")).read();
    refused += file.ok() ? 0 : 1;
    if (file.ok()) continue;
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << size << file.status();
  }
  EXPECT_GT(refused, whole.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(Gltf, DracoMethods,
                         ::testing::Values(draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING));

TEST(GltfDraco, RefusesWhatDoesNotFitItsAccessors) {
  const std::string bytes = draco_bytes(draco::MESH_EDGEBREAKER_ENCODING);
  for (const auto& [pointer, value, reason] :
       {std::tuple{"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", json(9),
                   "attribute \"POSITION\" has no accessor or no data in Draco, mesh 0 primitive 0"},
        {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", json("0"),
         "attributes of the wrong type or missing"},
        {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", json(99), "bufferView 99"},
        {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", json(1), "must be an object"},
        {"/accessors/2/type", json("VEC3"), "attribute \"TEXCOORD_0\" is another in Draco"},
        {"/accessors/2/count", json(2), "attribute \"TEXCOORD_0\" is another in Draco"},
        {"/accessors/1/count", json(4), "4 indices, mesh 0 primitive 0, must be a multiple of 3"},
        {"/accessors/1/componentType", json(kByte), "indices must be SCALAR of unsigned"},
        {"/meshes/0/primitives/0/indices", json(-1), "indices of the wrong type or missing"},
        {"/meshes/0/primitives/0/indices", json(9), "without accessors of positions and indices"},
        {"/meshes/0/primitives/0/mode", json(5), "Draco of other than triangles"}}) {
    Gltf gltf = draco_gltf(bytes);
    gltf.patch(pointer, value);
    const auto file = gltf.read();
    EXPECT_FALSE(file.ok()) << pointer;
    EXPECT_THAT(message(file), HasSubstr(reason)) << pointer;
  }
  EXPECT_THAT(message(draco_gltf("DRACO and no more").read()), HasSubstr("is no Draco mesh, mesh 0 primitive 0"));
}

TEST(GltfDraco, BoundsItsCountsBeforeItDecodes) {
  Gltf vertices = draco_gltf(draco_bytes(draco::MESH_EDGEBREAKER_ENCODING));
  vertices.accessor(0)["count"] = 14'000'000;
  EXPECT_THAT(message(vertices.read()),
              HasSubstr("14000000 vertices of a primitive in Draco, must be at most 4000000"));
  Gltf triangles = draco_gltf(draco_bytes(draco::MESH_EDGEBREAKER_ENCODING));
  triangles.accessor(1)["count"] = 60'000'000;
  EXPECT_THAT(message(triangles.read()), HasSubstr("20000000 triangles of a primitive in Draco, must be at most"));
}

TEST(GltfDraco, NamesOtherBitstreams) {
  std::string bytes = draco_bytes(draco::MESH_EDGEBREAKER_ENCODING);
  bytes[6] = 1;
  const auto file = draco_gltf(bytes).read();
  EXPECT_EQ(file.status().code(), absl::StatusCode::kUnimplemented);
  EXPECT_THAT(message(file), HasSubstr("Draco's bitstream 2.1 cannot be read"));
}

std::string encoded_positions() {
  const Sheet made = sheet();
  std::string bytes(meshopt_encodeVertexBufferBound(kVertices, sizeof(Vec3)), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(),
                                          made.positions.data(), kVertices, sizeof(Vec3)));
  return bytes;
}

std::string encoded_triangles() {
  const Sheet made = sheet();
  std::string bytes(meshopt_encodeIndexBufferBound(made.triangles.size(), kVertices), '\0');
  bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(),
                                         made.triangles.data(), made.triangles.size()));
  return bytes;
}

// Buffer 0 is the binary chunk with the compressed bytes, buffer 1 the fallback that is not there.
Gltf meshopt_gltf(const std::string& extension = "EXT_meshopt_compression") {
  Gltf gltf;
  gltf["bufferViews"] = json::array();
  const auto add = [&](const std::string& bytes, size_t count, size_t stride, const char* mode) {
    const int view = gltf.add_view(bytes);
    json& v = gltf["bufferViews"][static_cast<size_t>(view)];
    v["extensions"][extension] = {{"buffer", 0},
                                  {"byteOffset", v["byteOffset"]},
                                  {"byteLength", bytes.size()},
                                  {"byteStride", stride},
                                  {"count", count},
                                  {"mode", mode}};
    v["buffer"] = 1;
    v["byteOffset"] = 0;
    v["byteLength"] = count * stride;
  };
  add(encoded_positions(), kVertices, sizeof(Vec3), "ATTRIBUTES");
  add(encoded_triangles(), 3 * kTriangles, 4, "TRIANGLES");
  gltf["accessors"] = {
      {{"bufferView", 0}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", kVertices}},
      {{"bufferView", 1}, {"componentType", kUnsignedInt}, {"type", "SCALAR"}, {"count", 3 * kTriangles}}};
  const size_t bytes = gltf.binary().size();
  gltf["buffers"] = {{{"byteLength", bytes}},
                     {{"byteLength", 9999}, {"extensions", {{extension, {{"fallback", true}}}}}}};
  gltf["extensionsRequired"] = {extension};
  return gltf;
}

TEST(GltfMeshopt, DecodesToTheSameSurface) {
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto file = meshopt_gltf(extension).read();
    ASSERT_TRUE(file.ok()) << file.status();
    const Sheet made = sheet();
    EXPECT_EQ(file->meshes[0].positions, made.positions);
    EXPECT_EQ(surface(made.positions, file->meshes[0].triangles), surface(made.positions, made.triangles));
  }
}

TEST(GltfMeshopt, DecodesSequencesAndOctahedralNormals) {
  Gltf gltf;
  const std::vector<uint32_t> order = {0, 1, 2};
  std::string sequence(meshopt_encodeIndexSequenceBound(3, 3), '\0');
  sequence.resize(
      meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(sequence.data()), sequence.size(), order.data(), 3));
  const std::vector<float> directions = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0};  // of four numbers each
  std::array<int8_t, 12> octahedral;
  meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, directions.data());
  std::string normals(meshopt_encodeVertexBufferBound(3, 4), '\0');
  normals.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(normals.data()), normals.size(),
                                            octahedral.data(), 3, 4));
  const auto compress = [&](int accessor, size_t stride, const char* mode, const char* filter) {
    json& view = gltf["bufferViews"][static_cast<size_t>(accessor)];
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", view["byteOffset"]},
                                                     {"byteLength", view["byteLength"]},
                                                     {"byteStride", stride},
                                                     {"count", 3},
                                                     {"mode", mode},
                                                     {"filter", filter}};
    view["byteLength"] = 3 * stride;
  };
  gltf.primitive()["indices"] = gltf.add_accessor(sequence, kUnsignedShort, "SCALAR", 3);
  compress(2, 2, "INDICES", "NONE");
  gltf.primitive()["attributes"]["NORMAL"] = gltf.add_accessor(normals, kByte, "VEC3", 3, true);
  gltf["bufferViews"][3]["byteStride"] = 4;
  compress(3, 4, "ATTRIBUTES", "OCTAHEDRAL");
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->meshes[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_THAT(file->meshes[0].normals, ElementsAre(Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}));
}

TEST(GltfMeshopt, RefusesWhatDoesNotAddUp) {
  const std::string extension = "/bufferViews/0/extensions/EXT_meshopt_compression";
  for (const auto& [pointer, value, reason] :
       {std::tuple{extension + "/buffer", json(7), "buffer 7, meshopt compression of bufferView 0, there are 2"},
        {extension + "/byteOffset", json(2'000'000'000), "the buffer has"},
        {extension + "/byteLength", json(3), "cannot be decoded, meshopt compression of bufferView 0"},
        {extension + "/byteStride", json(6), "byteStride must be a multiple of 4, at most 256"},
        {extension + "/byteStride", json(0), "byteStride must be a multiple of 4, at most 256"},
        {extension + "/byteStride", json(260), "byteStride must be a multiple of 4, at most 256"},
        {extension + "/byteStride", json(-4), "byteStride of the wrong type or missing, bufferViews 0"},
        {extension + "/count", json(kVertices - 1), "cannot be decoded"},
        {extension + "/count", json(kVertices + 1), "byteLength 972 of bufferView 0, accessor 0, 984 bytes were"},
        {extension + "/mode", json("POINTS"), "mode \"POINTS\", meshopt compression of bufferView 0"},
        {extension + "/mode", json("TRIANGLES"), "byteStride must be 2 or 4"},
        {extension + "/filter", json("QUATERNION"), "byteStride must be 8"},
        {extension + "/filter", json(3), "filter of the wrong type or missing"},
        {"/bufferViews/1/extensions/EXT_meshopt_compression/count", json(4), "count must be a multiple of 3"},
        {"/bufferViews/0/extensions", json(4), "extensions of the wrong type"},
        {"/bufferViews/0/extensions", json::object(), "bytes 0 + 972 of bufferView 0, accessor 0, the buffer has 0"},
        {"/accessors/0/count", json(kVertices + 1), "elements of 12 bytes"}}) {
    Gltf gltf = meshopt_gltf();
    gltf.patch(pointer.c_str(), value);
    const auto file = gltf.read();
    EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument) << pointer << ": " << file.status();
    EXPECT_THAT(message(file), HasSubstr(reason)) << pointer << value;
  }
}

TEST(GltfMeshopt, BoundsWhatItDecodesTo) {
  Gltf gltf = meshopt_gltf();
  gltf.patch("/bufferViews/0/extensions/EXT_meshopt_compression/count", 2'000'000'000);
  const auto file = gltf.read();
  EXPECT_EQ(file.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(message(file), HasSubstr("must be at most 268435456 bytes in all"));
}

TEST(GltfMeshopt, NamesWhatItsDecoderDoesNotKnow) {
  Gltf filter = meshopt_gltf("KHR_meshopt_compression");
  filter.patch("/bufferViews/0/extensions/KHR_meshopt_compression/filter", "COLOR");
  EXPECT_EQ(filter.read().status().code(), absl::StatusCode::kUnimplemented);
  EXPECT_THAT(message(filter.read()), HasSubstr("filter \"COLOR\" cannot be read, meshopt compression"));
  Gltf version = meshopt_gltf();
  const json& view = version["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  version.binary().at(view["byteOffset"].get<size_t>()) = '\xa1';
  EXPECT_EQ(version.read().status().code(), absl::StatusCode::kUnimplemented);
  EXPECT_THAT(message(version.read()), HasSubstr("a later version of the codec cannot be read, meshopt compression"));
}

}  // namespace
}  // namespace diaphane::testing

// What glTF says that meshes are made of, and the pictures on them.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/readers/gltf_builder.h"
#include "tests/unit/readers/pictures.h"

namespace diaphane::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A triangle with texture coordinates and one material.
Gltf textured(const json& material, const std::string& picture = kRedGreenPng) {
  Gltf gltf;
  gltf.primitive()["attributes"]["TEXCOORD_0"] =
      gltf.add_accessor(Gltf::positions({0, 0, 1, 0, 0, 1}), kFloat, "VEC2", 3);
  gltf.primitive()["material"] = 0;
  gltf["materials"] = json::array({material});
  gltf["textures"] = {{{"source", 0}}};
  gltf["images"] = {{{"bufferView", gltf.add_view(picture)}, {"mimeType", "image/png"}}};
  return gltf;
}

TEST(GltfMaterials, AreABodyOfTheBaseColourUnderACoat) {
  Gltf gltf = textured({{"name", "shell"},
                        {"pbrMetallicRoughness",
                         {{"baseColorFactor", {0.25, 0.5, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                        {"extensions", {{"KHR_materials_ior", {{"ior", 1.4}}}}}});
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->warnings, IsEmpty());
  EXPECT_EQ(file->meshes[0].material, 0u);
  ASSERT_THAT(file->materials, SizeIs(1));
  const auto& body = std::get<DiffuseColor>(file->materials[0].material.model);
  EXPECT_EQ(body.color, (Rgb{0.25f, 0.5f, 0.95f}));
  EXPECT_EQ(body.mean_free_path_mm, (Rgb{1, 1, 1}));
  EXPECT_FLOAT_EQ(body.refractive_index, 1.4f);
  EXPECT_FLOAT_EQ(file->materials[0].material.coat->roughness, 0.25f);
  EXPECT_FALSE(file->materials[0].albedo.has_value());
  EXPECT_THAT(file->textures, IsEmpty());
}

TEST(GltfMaterials, OfAVolumeThatScattersAreThatVolume) {
  Gltf gltf = textured(
      {{"extensions",
        {{"KHR_materials_volume", {{"attenuationColor", {0.5, 0.6, 0.7}}, {"attenuationDistance", 0.002}}},
         {"KHR_materials_volume_scatter", {{"multiscatterColor", {0.9, 0.8, 0.7}}, {"scatterAnisotropy", 0.25}}}}}});
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  const auto& volume = std::get<Volume>(file->materials[0].material.model);
  EXPECT_EQ(volume.attenuation_color, (Rgb{0.5f, 0.6f, 0.7f}));
  EXPECT_FLOAT_EQ(volume.attenuation_distance_mm, 2);
  EXPECT_EQ(volume.multiscatter_color, (Rgb{0.9f, 0.8f, 0.7f}));
  EXPECT_FLOAT_EQ(volume.scatter_anisotropy, 0.25f);
  EXPECT_FLOAT_EQ(volume.refractive_index, 1.5f);
}

TEST(GltfMaterials, BringTheirPicturesEachOnceForWhatItIs) {
  const json picture = {{"index", 0}};
  Gltf gltf = textured({{"pbrMetallicRoughness",
                         {{"baseColorTexture", picture}, {"metallicRoughnessTexture", picture}, {"metallicFactor", 0}}},
                        {"normalTexture", {{"index", 0}, {"scale", 0.5}}}});
  gltf["samplers"] = {{{"wrapS", 33071}}};
  gltf.patch("/textures/0/sampler", 0);
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  // One as sRGB, one as it is for normals and roughness.
  ASSERT_THAT(file->textures, SizeIs(2));
  const FileMaterial& material = file->materials[0];
  EXPECT_EQ(material.normal, material.roughness);
  EXPECT_FLOAT_EQ(material.normal_scale, 0.5f);
  const TextureData& albedo = file->textures[*material.albedo];
  EXPECT_TRUE(albedo.srgb);
  EXPECT_TRUE(albedo.clamp_u);
  EXPECT_FALSE(albedo.clamp_v);
  EXPECT_EQ(albedo.width_px, 2u);
  EXPECT_EQ(albedo.height_px, 1u);
  EXPECT_THAT(albedo.rgba, ElementsAre(255, 0, 0, 255, 0, 255, 0, 255));
  EXPECT_FALSE(file->textures[*material.normal].srgb);
}

TEST(GltfMaterials, ReadJpegAndWebpAndPicturesBesideTheFile) {
  for (const std::string& picture : {kGreyJpeg, kGreyWebp}) {
    Gltf gltf = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, picture);
    const auto file = gltf.read();
    ASSERT_TRUE(file.ok()) << file.status();
    ASSERT_THAT(file->textures, SizeIs(1)) << ::testing::PrintToString(file->warnings);
    EXPECT_NEAR(file->textures[0].rgba[0], 128, 2);
    EXPECT_EQ(file->textures[0].rgba[3], 255);
  }
  const ScratchFolder folder;
  folder.write("look/red.png", kRedGreenPng);
  Gltf gltf = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  gltf["images"] = {{{"uri", "look/red.png"}}};
  const auto file = read_mesh_file(folder.write("a.glb", gltf.as_glb()));
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->textures, SizeIs(1));
}

TEST(GltfMaterials, MoveTextureCoordinatesAsTheirTransformSays) {
  const json transform = {{"offset", {0.5, 0.25}}, {"rotation", std::acos(0.0)}, {"scale", {2, 3}}};
  Gltf gltf =
      textured({{"pbrMetallicRoughness",
                 {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  // (1, 0) is scaled to (2, 0) and turned, as one sees it, counter-clockwise: up.
  const std::vector<TextureCoordinate>& moved = file->meshes[0].texture_coordinates;
  EXPECT_THAT(moved[0].u, FloatNear(0.5f, 1e-6f));
  EXPECT_THAT(moved[1].u, FloatNear(0.5f, 1e-6f));
  EXPECT_THAT(moved[1].v, FloatNear(0.25f - 2, 1e-6f));
  EXPECT_THAT(moved[2].u, FloatNear(0.5f + 3, 1e-6f));
}

TEST(GltfMaterials, TakeTheTextureCoordinatesThatTheirPicturesName) {
  Gltf gltf = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}},
                        {"normalTexture", {{"index", 0}}}});
  gltf.primitive()["attributes"]["TEXCOORD_1"] =
      gltf.add_accessor(Gltf::positions({5, 6, 7, 8, 9, 10}), kFloat, "VEC2", 3);
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->meshes[0].texture_coordinates[0], (TextureCoordinate{5, 6}));
  EXPECT_FALSE(file->materials[0].normal.has_value());
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr("normals, whose texture coordinates are others")));
}

struct Damage {
  const char* pointer;
  const char* value;  // JSON
  const char* warning;
};

class GltfLooksDamage : public ::testing::TestWithParam<Damage> {};

TEST_P(GltfLooksDamage, LeavesThePictureOutWithAWarning) {
  Gltf gltf = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  gltf.patch(GetParam().pointer, json::parse(GetParam().value));
  const auto file = gltf.read();
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->textures, IsEmpty());
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr(GetParam().warning)));
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfLooksDamage,
    ::testing::Values(Damage{"/materials", "{}", "materials that the file does not have"},
                      Damage{"/materials/0", "[1]", "materials that the file does not have"},
                      Damage{"/meshes/0/primitives/0/material", "7", "materials that the file does not have"},
                      Damage{"/textures", "[]", "a texture that the file does not have"},
                      Damage{"/textures/0/source", "-5", "image -5: is not there"},
                      Damage{"/images/0", "{}", "image 0: has neither bufferView nor uri"},
                      Damage{"/images/0", "{\"bufferView\": 99}", "image 0"},
                      Damage{"/images/0", "{\"bufferView\": 0}", "image 0: is neither PNG nor JPEG nor WebP"},
                      Damage{"/images/0", "{\"uri\": \"../x.png\"}", "may not be opened"},
                      Damage{"/images/0", "{\"uri\": \"data:image/png;base64,AAAA\"}", "is neither PNG"}));

TEST(GltfMaterials, KeepWithinTheLimitOfPixels) {
  Gltf gltf = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const auto file = gltf.read({.max_texture_pixels = 1});
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_THAT(file->textures, IsEmpty());
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr("2 pixels, must be at most 1")));
}

TEST(Images, AreRefusedWhereTheyEndEarly) {
  const ScratchFolder folder;
  for (const std::string& whole : {kRedGreenPng, kGreyJpeg, kGreyWebp}) {
    for (size_t size = 0; size < whole.size(); ++size) {
      const auto texture = read_texture_file(folder.write("a", whole.substr(0, size)), true);
      // What ends within a checksum or an end mark after the last pixel may do.
      if (texture.ok() && size + 14 >= whole.size()) continue;
      EXPECT_EQ(texture.status().code(), absl::StatusCode::kInvalidArgument) << size << " of " << whole.size();
    }
    EXPECT_TRUE(read_texture_file(folder.write("a", whole), true).ok());
  }
  EXPECT_EQ(read_texture_file("/nowhere/a.png", true).status().code(), absl::StatusCode::kNotFound);
}

TEST(Images, AreDecodedFromBytesAsFromFiles) {
  const ScratchFolder folder;
  for (const std::string& whole : {kRedGreenPng, kGreyJpeg, kGreyWebp}) {
    const auto picture = decode_texture(whole, true);
    ASSERT_TRUE(picture.ok()) << picture.status();
    const auto file = read_texture_file(folder.write("a", whole), true);
    EXPECT_EQ(picture->rgba, file->rgba);
    EXPECT_EQ(picture->width_px, file->width_px);
    EXPECT_TRUE(picture->srgb);
  }
  EXPECT_THAT(std::string(decode_texture("P6 1 1 255", true).status().message()),
              HasSubstr("picture: is neither PNG nor JPEG nor WebP"));
}

TEST(Images, ThatClaimToBeHugeAreRefusedBeforeAnythingIsMadeOfThem) {
  std::string png = kRedGreenPng;
  png.replace(16, 4, std::string("\x7f\xff\xff\xff", 4));
  const ScratchFolder folder;
  const auto texture = read_texture_file(folder.write("a.png", png), true);
  EXPECT_FALSE(texture.ok());
}

}  // namespace
}  // namespace diaphane::testing

// Textures and colours of vertices: what they multiply, once, by every technique.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"

namespace diaphane::render {
namespace {

using Scene = std::shared_ptr<scene::SceneSnapshot>;

constexpr uint32_t kSize_px = 64;

class TexturedFrames : public SharedRenderer {};

/// A square of 20 mm, lit from the front, whose texture coordinates go from 0, 0 at its upper left to 1, 1.
Scene make_square(float repeats = 1) {
  Triangles square = make_plane(20, 24);
  auto attributes = std::make_shared<geometry::SurfaceAttributes>();
  for (const glm::vec3& p : square.positions) {
    attributes->texture_coordinates.push_back(repeats * glm::vec2(p.x / 20 + 0.5f, 0.5f - p.y / 20));
  }
  Scene scene = make_scene(std::move(square), "marble");
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes.front());
  mesh->attributes = std::move(attributes);
  scene->meshes.front() = std::move(mesh);
  add_point_light(*scene, {4, 3, 30}, 1000);
  return scene;
}

void add_texture(scene::SceneSnapshot& scene, const std::string& id, uint32_t width_px, std::vector<uint8_t> rgba,
                 bool srgb) {
  scene::TexturePixels pixels{width_px, static_cast<uint32_t>(rgba.size() / 4 / width_px), std::move(rgba)};
  scene.textures.push_back({id, std::make_shared<const scene::TexturePixels>(std::move(pixels)), {srgb, true, true}});
}

std::vector<uint8_t> checker(uint32_t size_px) {
  std::vector<uint8_t> rgba;
  for (uint32_t y = 0; y < size_px; ++y) {
    for (uint32_t x = 0; x < size_px; ++x) {
      const auto value = static_cast<uint8_t>((x + y) % 2 * 255);
      rgba.insert(rgba.end(), {value, value, value, 255});
    }
  }
  return rgba;
}

FrameRequest request_of(Scene scene, Technique technique) {
  FrameRequest request{std::move(scene), {{0, 0, 60}, {0, 0, 0}, {0, 1, 0}, 30}, kSize_px, kSize_px, {}};
  request.settings.technique = technique;
  request.format = PixelFormat::kLinearFloat;
  return request;
}

glm::vec3 pixel(const std::vector<float>& values, uint32_t x, uint32_t y) {
  const float* p = &values[4 * (y * kSize_px + x)];
  return {p[0], p[1], p[2]};
}

constexpr Technique kAll[] = {Technique::kIntegral, Technique::kPaper, Technique::kLambert, Technique::kReference};

/// Of an sRGB code (IEC 61966-2-1), 0..255.
float linear_of(float code) {
  const float value = code / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

TEST_F(TexturedFrames, AFlatAlbedoMultipliesOnce) {
  for (const Technique technique : kAll) {
    Scene plain = make_square(), textured = make_square();
    const std::vector<uint8_t> codes = {188, 128, 64, 255};
    add_texture(*textured, "albedo", 1, codes, true);
    textured->materials.front().textures.albedo = "albedo";
    const std::vector<float> before = render(request_of(plain, technique));
    const std::vector<float> after = render(request_of(textured, technique));
    for (const auto& [x, y] : {std::pair(32u, 32u), std::pair(20u, 40u), std::pair(44u, 24u)}) {
      const glm::vec3 a = pixel(before, x, y), b = pixel(after, x, y);
      ASSERT_GT(a.g, 0);
      for (int c = 0; c < 3; ++c) {
        // GL may decode a code to what lies within half a step of it.
        const auto code = static_cast<float>(codes[c]);
        EXPECT_GT(b[c] / a[c], linear_of(code - 0.5f)) << static_cast<int>(technique) << " channel " << c;
        EXPECT_LT(b[c] / a[c], linear_of(code + 0.5f)) << static_cast<int>(technique) << " channel " << c;
      }
    }
  }
}

TEST_F(TexturedFrames, ColoursOfVerticesMultiplyOnceAndTogetherWithTheAlbedo) {
  for (const Technique technique : kAll) {
    Scene plain = make_square(), colored = make_square();
    auto mesh = std::make_shared<scene::Mesh>(*colored->meshes.front());
    auto attributes = std::make_shared<geometry::SurfaceAttributes>(*mesh->attributes);
    attributes->colors.assign(attributes->texture_coordinates.size(), {0.5f, 1, 0.25f});
    mesh->attributes = attributes;
    colored->meshes.front() = mesh;
    add_texture(*colored, "albedo", 1, {51, 255, 255, 255}, false);
    colored->materials.front().textures.albedo = "albedo";
    const glm::vec3 a = pixel(render(request_of(plain, technique)), 30, 30);
    const glm::vec3 b = pixel(render(request_of(colored, technique)), 30, 30);
    EXPECT_NEAR(b.r / a.r, 0.1f, 2e-4f) << static_cast<int>(technique);
    EXPECT_NEAR(b.g / a.g, 1, 1e-3f);
    EXPECT_NEAR(b.b / a.b, 0.25f, 3e-4f);
  }
}

TEST_F(TexturedFrames, TheFirstRowOfAPictureIsAboveAndItsFirstColumnLeft) {
  Scene scene = make_square();
  // Red green / blue white.
  add_texture(*scene, "albedo", 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}, false);
  scene->materials.front().textures.albedo = "albedo";
  for (const Technique technique : kAll) {
    const std::vector<float> values = render(request_of(scene, technique));
    const glm::vec3 upper_left = pixel(values, 20, 20), upper_right = pixel(values, 43, 20);
    const glm::vec3 lower_left = pixel(values, 20, 43);
    EXPECT_GT(upper_left.r, 20 * upper_left.g) << static_cast<int>(technique);
    EXPECT_GT(upper_right.g, 20 * upper_right.r);
    EXPECT_GT(lower_left.b, 20 * lower_left.r);
  }
}

TEST_F(TexturedFrames, FromAfarACheckerOfSrgbIsTheMeanOfItsLight) {
  // 256 squares and more in the width of a pixel's few: mip maps alone can average them.
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper}) {
    Scene plain = make_square(), textured = make_square(8);
    add_texture(*textured, "albedo", 256, checker(256), true);
    textured->textures.front().sampling.clamp_u = textured->textures.front().sampling.clamp_v = false;
    textured->materials.front().textures.albedo = "albedo";
    const glm::vec3 a = pixel(render(request_of(plain, technique)), 30, 30);
    const glm::vec3 b = pixel(render(request_of(textured, technique)), 30, 30);
    // A mean of the codes would come to 0.22; 8 bits hold 0.5 to half a step of 0.4 %.
    EXPECT_NEAR(b.g / a.g, 0.5f, 4e-3f);
  }
}

TEST_F(TexturedFrames, ASceneLetGoAndANewOneWithTheSameNamesShowTheirOwn) {
  for (const uint8_t value : {uint8_t{51}, uint8_t{204}}) {
    Scene plain = make_square(), scene = make_square();
    add_texture(*scene, "albedo", 1, {value, value, value, 255}, false);
    scene->materials.front().textures.albedo = "albedo";
    const glm::vec3 a = pixel(render(request_of(plain, Technique::kIntegral)), 30, 30);
    const glm::vec3 b = pixel(render(request_of(scene, Technique::kIntegral)), 30, 30);
    EXPECT_NEAR(b.g / a.g, value / 255.0f, 1e-3f);
  }
}

TEST_F(TexturedFrames, ChannelsHoldWhatLeavesThroughTheAlbedo) {
  for (const Technique technique : kAll) {
    Scene plain = make_square(), textured = make_square();
    add_texture(*textured, "albedo", 1, {51, 51, 51, 255}, false);
    textured->materials.front().textures.albedo = "albedo";
    FrameRequest request = request_of(plain, technique);
    request.channels = {Channel::kRadiosity, Channel::kIrradiance};
    const std::vector<float> before = render(request);
    request.scene = textured;
    const std::vector<float> after = render(request);
    const size_t at = before.size() / (kSize_px * kSize_px) * (30 * kSize_px + 30);
    EXPECT_NEAR(after[at + 4] / before[at + 4], 0.2f, 2e-4f) << static_cast<int>(technique);
    EXPECT_FLOAT_EQ(after[at + 7], before[at + 7]);
  }
}

/// A square under a coat, and how bright its mirrored highlight is at a pixel.
Scene make_coated_square(float roughness) {
  Scene scene = make_square();
  scene->materials.front().coat = optics::Coat{roughness};
  return scene;
}

TEST_F(TexturedFrames, ANormalMapTurnsTheCoatAlone) {
  // A slope of 0.1 along the picture's +x, and then along its +y, moves the highlight of a light that is straight ahead
  // by the same angle the other way.
  for (const auto& [code, expected_x, expected_y] :
       {std::tuple(std::vector<uint8_t>{128, 128, 255, 255}, 0.0f, 0.0f),
        std::tuple(std::vector<uint8_t>{140, 128, 254, 255}, -1.0f, 0.0f),
        std::tuple(std::vector<uint8_t>{128, 140, 254, 255}, 0.0f, -1.0f)}) {
    Scene scene = make_coated_square(0.15f), bare = make_square();
    scene->lights.clear();
    bare->lights.clear();
    add_point_light(*scene, {0, 0, 60}, 1000);
    add_point_light(*bare, {0, 0, 60}, 1000);
    add_texture(*scene, "normal", 1, code, false);
    scene->materials.front().textures.normal = "normal";
    const std::vector<float> coated = render(request_of(scene, Technique::kIntegral));
    const std::vector<float> below = render(request_of(bare, Technique::kIntegral));
    float sum = 0, sum_x = 0, sum_y = 0;
    for (uint32_t y = 8; y < kSize_px - 8; ++y) {
      for (uint32_t x = 8; x < kSize_px - 8; ++x) {
        const float highlight = pixel(coated, x, y).g - pixel(below, x, y).g;
        EXPECT_GE(highlight, -1e-5f * pixel(below, x, y).g);
        sum += highlight;
        sum_x += highlight * (static_cast<float>(x) - 31.5f);
        sum_y += highlight * (31.5f - static_cast<float>(y));
      }
    }
    ASSERT_GT(sum, 0);
    // The eye and the light are 60 mm away, a pixel is half a millimetre wide: 0.095 · 60 / 0.502 pixels, or less where
    // the square ends.
    EXPECT_NEAR(sum_x / sum, 8.0f * expected_x, expected_x == 0 ? 0.2f : 4.0f);
    EXPECT_NEAR(sum_y / sum, 8.0f * expected_y, expected_y == 0 ? 0.2f : 4.0f);
  }
}

TEST_F(TexturedFrames, ARoughnessMapIsTheSquareRootOfTheCoatsShare) {
  // Green 180/255, squared, is 0.498: within half a step of 16/32.
  for (const Technique technique : {Technique::kIntegral, Technique::kReference}) {
    Scene half = make_coated_square(0.2f), mapped = make_coated_square(0.4f);
    add_texture(*mapped, "roughness", 1, {0, 180, 255, 255}, false);
    mapped->materials.front().textures.roughness = "roughness";
    const std::vector<float> expected = render(request_of(half, technique));
    const std::vector<float> found = render(request_of(mapped, technique));
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-4f + 1e-3f * expected[i]);
  }
}

}  // namespace
}  // namespace diaphane::render

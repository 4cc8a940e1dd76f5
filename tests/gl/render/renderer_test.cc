// The renderer as the service sees it: frames of scenes, and which stages ran.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "glm/gtc/matrix_transform.hpp"
#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"

namespace diaphane::render {
namespace {

const std::atomic<bool> kNotCancelled = false;

class Renderer : public BothRasters {
 protected:
  Frame render(const FrameRequest& request) {
    absl::StatusOr<Frame> frame = renderer_->render(request, kNotCancelled);
    EXPECT_TRUE(frame.ok()) << frame.status();
    return frame.ok() ? *std::move(frame) : Frame{};
  }

  static std::map<std::string, bool> ran(const Frame& frame) {
    std::map<std::string, bool> stages;
    for (const StageTime& stage : frame.stages) stages[stage.stage] = stage.ran;
    return stages;
  }

  static FrameRequest request_of(std::shared_ptr<const scene::SceneSnapshot> scene) {
    FrameRequest request;
    request.scene = std::move(scene);
    request.settings.technique = Technique::kPaper;
    request.camera.eye = {0, 0, 60};
    request.width_px = 96;
    request.height_px = 64;
    return request;
  }
};
INSTANTIATE_TEST_SUITE_P(, Renderer, kBothRasters, name_of_raster);

std::shared_ptr<scene::SceneSnapshot> marble_box() {
  auto scene = make_scene(make_box({20, 20, 20}, 8), "marble");
  add_point_light(*scene, {20, 30, 40}, 4000);
  return scene;
}

TEST_P(Renderer, SaysWhichContextItGotAndWhy) {
  const RendererInfo info = renderer_->info();
  EXPECT_FALSE(info.gl_renderer.empty());
  EXPECT_FALSE(info.reason.empty());
}

TEST_P(Renderer, DrawsTheBodyInTheMiddleAndNothingAround) {
  const Frame frame = render(request_of(marble_box()));
  const auto& image = std::get<base::Image8>(frame.image);
  ASSERT_EQ(image.rgba.size(), 96u * 64 * 4);
  const auto alpha = [&](uint32_t x, uint32_t y) { return image.rgba[4 * (y * 96 + x) + 3]; };
  EXPECT_EQ(alpha(48, 32), 255);
  EXPECT_EQ(alpha(2, 2), 0);
  EXPECT_GT(image.rgba[4 * (32 * 96 + 48)], 30);
}

TEST_P(Renderer, LeavesTheSceneWithoutMeshesToTheCaller) {
  FrameRequest request = request_of(std::make_shared<scene::SceneSnapshot>());
  EXPECT_EQ(renderer_->render(request, kNotCancelled).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST_P(Renderer, RefusesTheIntegralOfABodyTooFarAway) {
  const auto scene = marble_box();
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  mesh->scene_from_mesh[3] = glm::vec4(2e7f, 0, 0, 1);
  auto far = std::make_shared<scene::SceneSnapshot>(*scene);
  far->meshes[0] = mesh;
  FrameRequest request = request_of(far);
  request.settings.technique = Technique::kIntegral;
  EXPECT_EQ(renderer_->render(request, kNotCancelled).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST_P(Renderer, IntegralSleepsUntilWhatAStageReadsChanges) {
  const auto scene = marble_box();
  FrameRequest request = request_of(scene);
  request.settings.technique = Technique::kIntegral;
  render(request);
  request.camera.eye = {10, 0, 60};
  auto stages = ran(render(request));
  for (const char* stage : {"place", "refine", "normals", "refit", "irradiance", "flux", "gather"}) {
    EXPECT_FALSE(stages.at(stage)) << stage;
  }
  if (native()) {
    EXPECT_FALSE(stages.contains("upload"));
    EXPECT_TRUE(stages.at("raster"));
  } else {
    EXPECT_FALSE(stages.at("upload"));
    EXPECT_TRUE(stages.at("draw"));
  }

  auto other_material = std::make_shared<scene::SceneSnapshot>(*scene);
  other_material->materials[0].coefficients.absorption_mm = {0.0025f, 0.0045f, 0.0075f};
  request.scene = other_material;
  stages = ran(render(request));
  EXPECT_FALSE(stages.at("refit"));
  EXPECT_FALSE(stages.at("irradiance")) << "irradiance does not depend on absorption";
  EXPECT_TRUE(stages.at("gather"));

  auto moved_light = std::make_shared<scene::SceneSnapshot>(*other_material);
  std::get<scene::PointLight>(moved_light->lights[0].kind).position.x += 5;
  request.scene = moved_light;
  stages = ran(render(request));
  EXPECT_FALSE(stages.at("refit"));
  EXPECT_TRUE(stages.at("irradiance"));
  EXPECT_TRUE(stages.at("gather"));
}

TEST_P(Renderer, IntegralDoesNotCareWhereOrHowTheSceneIsTurned) {
  const auto scene = marble_box();
  FrameRequest request = request_of(scene);
  request.settings.technique = Technique::kIntegral;
  request.format = PixelFormat::kLinearFloat;
  const auto still = std::get<base::ImageF>(render(request).image).values;

  const glm::mat4 turn = glm::rotate(glm::translate(glm::mat4(1), {30, -20, 10}), 0.7f, glm::vec3(0.6f, 0.8f, 0));
  const auto moved = [&](const glm::vec3& p) { return glm::vec3(turn * glm::vec4(p, 1)); };
  auto turned = std::make_shared<scene::SceneSnapshot>(*scene);
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  mesh->scene_from_mesh = turn;
  turned->meshes[0] = mesh;
  glm::vec3& light = std::get<scene::PointLight>(turned->lights[0].kind).position;
  light = moved(light);
  request.scene = turned;
  request.camera.eye = moved(request.camera.eye);
  request.camera.target = moved(request.camera.target);
  request.camera.up = glm::vec3(turn * glm::vec4(request.camera.up, 0));
  const auto after = std::get<base::ImageF>(render(request).image).values;
  double difference = 0;
  double sum = 0;
  for (size_t i = 0; i < still.size(); ++i) {
    // A pixel at the silhouette may fall on either side.
    if (still[i - i % 4 + 3] != after[i - i % 4 + 3]) continue;
    difference += std::abs(still[i] - after[i]);
    sum += still[i];
  }
  EXPECT_LT(difference, 0.003 * sum);
}

TEST_P(Renderer, IntegralOfADeformedBodyReturnsToTheSameBytes) {
  const auto scene = marble_box();
  FrameRequest request = request_of(scene);
  request.settings.technique = Technique::kIntegral;
  const auto first = std::get<base::Image8>(render(request).image).rgba;
  auto deformed = std::make_shared<scene::SceneSnapshot>(*scene);
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  auto shape = std::make_shared<geometry::MeshShape>(*mesh->shape);
  for (glm::vec3& p : shape->positions) p.x *= 1.5f;
  mesh->shape = shape;
  deformed->meshes[0] = mesh;
  request.scene = deformed;
  EXPECT_NE(std::get<base::Image8>(render(request).image).rgba, first);
  request.scene = scene;
  EXPECT_EQ(std::get<base::Image8>(render(request).image).rgba, first);
}

TEST_P(Renderer, ShadowsOfOneMeshFallOnAnother) {
  auto scene = make_scene(make_box({10, 10, 2}, 8), "marble");
  add_point_light(*scene, {0, 0, 40}, 4000);
  auto shade = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  shade->name = "scenes/test/meshes/shade";
  shade->scene_from_mesh[3] = glm::vec4(0, 0, 20, 1);
  scene->meshes.push_back(shade);
  FrameRequest request = request_of(scene);
  request.settings.technique = Technique::kIntegral;
  request.camera.eye = {25, 0, 12};
  request.format = PixelFormat::kLinearFloat;
  const auto mean = [&] {
    const auto values = std::get<base::ImageF>(render(request).image).values;
    double sum = 0;
    for (const float v : values) sum += v;
    return sum;
  };
  const double shadowed = mean();
  request.settings.shadows = false;
  EXPECT_LT(shadowed, mean());
}

TEST_P(Renderer, DirectionalAndSpotLightsReachTheBody) {
  auto scene = make_scene(make_box({10, 10, 10}, 8), "marble");
  scene->lights.push_back({"scenes/test/lights/d", scene::DirectionalLight{{0, 0, -1}, glm::vec3(3)}});
  FrameRequest request = request_of(scene);
  request.format = PixelFormat::kLinearFloat;
  const auto centre = [&](Technique technique) {
    request.settings.technique = technique;
    return std::get<base::ImageF>(render(request).image).values[4 * (32 * 96 + 48)];
  };
  const float directional = centre(Technique::kIntegral);
  EXPECT_GT(directional, 0.1f);
  EXPECT_GT(centre(Technique::kPaper), 0);

  auto spot = std::make_shared<scene::SceneSnapshot>(*scene);
  spot->lights[0].kind = scene::SpotLight{{{0, 0, 1000}, glm::vec3(3e6f)}, {0, 0, -1}, 20, 30};
  request.scene = spot;
  EXPECT_NEAR(centre(Technique::kIntegral) / directional, 1, 0.03) << "far away, a spot is a directional light";

  auto elsewhere = std::make_shared<scene::SceneSnapshot>(*spot);
  std::get<scene::SpotLight>(elsewhere->lights[0].kind).direction = {1, 0, 0};
  request.scene = elsewhere;
  EXPECT_EQ(centre(Technique::kIntegral), 0);
}

TEST_P(Renderer, StopsWhenCancelled) {
  const std::atomic<bool> cancelled = true;
  EXPECT_EQ(renderer_->render(request_of(marble_box()), cancelled).status().code(), absl::StatusCode::kCancelled);
}

TEST_P(Renderer, SleepsWhatDidNotChange) {
  const auto scene = marble_box();
  FrameRequest request = request_of(scene);
  render(request);
  request.camera.eye = {10, 0, 60};
  auto stages = ran(render(request));
  EXPECT_FALSE(stages.at("place"));
  if (!native()) {
    EXPECT_FALSE(stages.at("upload"));
  }
  EXPECT_FALSE(stages.at("atlas"));
  EXPECT_TRUE(stages.at(native() ? "raster" : "gbuffer"));
  EXPECT_TRUE(stages.at("shade"));

  auto moved_light = std::make_shared<scene::SceneSnapshot>(*scene);
  std::get<scene::PointLight>(moved_light->lights[0].kind).position.x += 5;
  request.scene = moved_light;
  stages = ran(render(request));
  EXPECT_FALSE(stages.at("place"));
  EXPECT_TRUE(stages.at("atlas"));

  auto other_material = std::make_shared<scene::SceneSnapshot>(*moved_light);
  other_material->materials[0].coefficients.absorption_mm = {0.1f, 0.1f, 0.1f};
  request.scene = other_material;
  stages = ran(render(request));
  EXPECT_FALSE(stages.at("place"));
  EXPECT_FALSE(stages.at("atlas")) << "irradiance does not depend on absorption";

  auto deformed = std::make_shared<scene::SceneSnapshot>(*other_material);
  auto mesh = std::make_shared<scene::Mesh>(*deformed->meshes[0]);
  auto shape = std::make_shared<geometry::MeshShape>(*mesh->shape);
  shape->positions[0].x += 1;
  mesh->shape = shape;
  deformed->meshes[0] = mesh;
  request.scene = deformed;
  stages = ran(render(request));
  EXPECT_TRUE(stages.at("place"));
  if (!native()) {
    EXPECT_TRUE(stages.at("upload"));
  }
  EXPECT_TRUE(stages.at("atlas"));
}

TEST_P(Renderer, EachChangeShowsInThePicture) {
  const auto scene = marble_box();
  FrameRequest request = request_of(scene);
  const auto pixels = [&](const FrameRequest& r) { return std::get<base::Image8>(render(r).image).rgba; };
  const auto first = pixels(request);
  auto other_material = std::make_shared<scene::SceneSnapshot>(*scene);
  other_material->materials[0].coefficients.absorption_mm = {0.1f, 0.5f, 0.9f};
  auto other_light = std::make_shared<scene::SceneSnapshot>(*scene);
  std::get<scene::PointLight>(other_light->lights[0].kind).position.x -= 40;
  FrameRequest changed = request;
  changed.scene = other_material;
  EXPECT_NE(pixels(changed), first);
  changed.scene = other_light;
  EXPECT_NE(pixels(changed), first);
  changed = request;
  changed.camera.eye.x += 8;
  EXPECT_NE(pixels(changed), first);
  EXPECT_EQ(pixels(request), first);
}

TEST_P(Renderer, DeformingAndReturningGivesTheSameBytes) {
  const auto scene = marble_box();
  const FrameRequest request = request_of(scene);
  const auto first = std::get<base::Image8>(render(request).image).rgba;
  auto deformed = std::make_shared<scene::SceneSnapshot>(*scene);
  auto mesh = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  auto shape = std::make_shared<geometry::MeshShape>(*mesh->shape);
  for (glm::vec3& p : shape->positions) p *= 1.3f;
  mesh->shape = shape;
  deformed->meshes[0] = mesh;
  FrameRequest other = request;
  other.scene = deformed;
  EXPECT_NE(std::get<base::Image8>(render(other).image).rgba, first);

  auto returned = std::make_shared<scene::SceneSnapshot>(*deformed);
  auto back = std::make_shared<scene::Mesh>(*mesh);
  back->shape = std::make_shared<geometry::MeshShape>(*scene->meshes[0]->shape);
  returned->meshes[0] = back;
  other.scene = returned;
  EXPECT_EQ(std::get<base::Image8>(render(other).image).rgba, first);
}

TEST_P(Renderer, ExposureDoublesPicturesByStopsAndLeavesLinearPixelsAlone) {
  FrameRequest request = request_of(marble_box());
  request.format = PixelFormat::kLinearFloat;
  const auto linear = std::get<base::ImageF>(render(request).image).values;
  request.settings.exposure_ev = 3;
  EXPECT_EQ(std::get<base::ImageF>(render(request).image).values, linear);
  request.format = PixelFormat::kSrgb8;
  const auto bright = std::get<base::Image8>(render(request).image).rgba;
  request.settings.exposure_ev = 0;
  EXPECT_GT(bright[4 * (32 * 96 + 48)], std::get<base::Image8>(render(request).image).rgba[4 * (32 * 96 + 48)]);
}

TEST_P(Renderer, SamplesCoverAnEdgeByTheirShare) {
  auto scene = make_scene(make_plane(10, 4), "marble");
  add_point_light(*scene, {0, 0, 50}, 1e5f);
  FrameRequest request = request_of(scene);
  request.format = PixelFormat::kLinearFloat;
  request.camera = {{0, 0, 100}, {0, 0, 0}, {0, 1, 0}, 30};
  request.width_px = request.height_px = 33;
  const auto alphas = [&](uint32_t samples) {
    request.settings.samples = samples;
    const auto values = std::get<base::ImageF>(render(request).image).values;
    double covered = 0;
    for (size_t i = 3; i < values.size(); i += 4) covered += values[i];
    return covered;
  };
  const double pixel = 2 * 100 * std::tan(15 * std::numbers::pi / 180) / 33;
  const double exact = 100 / (pixel * pixel);
  EXPECT_NEAR(alphas(64), exact, 0.01 * exact);
  EXPECT_GT(std::abs(alphas(1) - exact), 0.01 * exact);
}

TEST_P(Renderer, SamplesLeaveWhatLiesWithinThePictureAsItIs) {
  FrameRequest request = request_of(marble_box());
  request.format = PixelFormat::kLinearFloat;
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper, Technique::kLambert}) {
    request.settings.technique = technique;
    request.settings.samples = 1;
    const auto one = std::get<base::ImageF>(render(request).image).values;
    request.settings.samples = 4;
    const auto four = std::get<base::ImageF>(render(request).image).values;
    const size_t centre = 4 * (32 * 96 + 48);
    EXPECT_NEAR(four[centre], one[centre], 0.02f * one[centre]);
    EXPECT_EQ(four[centre + 3], 1);
    EXPECT_EQ(four[3], 0);
  }
}

TEST_P(Renderer, SamplesLeaveExtraChannelsAtThePixelsCentre) {
  FrameRequest request = request_of(marble_box());
  request.format = PixelFormat::kLinearFloat;
  request.channels = {Channel::kDepth, Channel::kRadiosity};
  const auto one = std::get<base::ImageF>(render(request).image).values;
  request.settings.samples = 3;
  const auto three = std::get<base::ImageF>(render(request).image).values;
  ASSERT_EQ(one.size(), three.size());
  for (size_t i = 0; i < one.size(); ++i) {
    if (i % 8 < 4) continue;
    ASSERT_EQ(one[i], three[i]) << i;
  }
}

TEST_P(Renderer, DevelopsAsTheDriverStores) {
  FrameRequest request = request_of(marble_box());
  request.settings.exposure_ev = 1;
  const auto stored = std::get<base::Image8>(render(request).image).rgba;
  request.settings.background = glm::vec3(0);
  const auto developed = std::get<base::Image8>(render(request).image).rgba;
  for (size_t i = 0; i < stored.size(); ++i) {
    if (i % 4 == 3) continue;
    ASSERT_NEAR(stored[i], developed[i], 1) << i;
  }
}

TEST_P(Renderer, ShowsTheBackgroundWhereNoSurfaceIsInLinearPixelsToo) {
  FrameRequest request = request_of(marble_box());
  request.settings.background = glm::vec3(0.25f, 0.5f, 2);
  const auto picture = std::get<base::Image8>(render(request).image).rgba;
  EXPECT_THAT(std::vector<int>(picture.begin(), picture.begin() + 4), testing::ElementsAre(137, 188, 255, 255));
  request.format = PixelFormat::kLinearFloat;
  const auto linear = std::get<base::ImageF>(render(request).image).values;
  EXPECT_THAT(std::vector<float>(linear.begin(), linear.begin() + 4), testing::ElementsAre(0.25f, 0.5f, 2, 1));
}

TEST_P(Renderer, FindsAnExposureThatHoldsForAnyStrengthOfLight) {
  auto dim = make_scene(make_box({10, 10, 10}, 4), "marble");
  add_point_light(*dim, {30, 40, 50}, 1e2f);
  auto bright = make_scene(make_box({10, 10, 10}, 4), "marble");
  add_point_light(*bright, {30, 40, 50}, 1e5f);
  FrameRequest request = request_of(dim);
  request.settings.auto_exposure = true;
  const Frame of_dim = render(request);
  request.scene = bright;
  const Frame of_bright = render(request);
  EXPECT_NEAR(of_dim.exposure_ev - of_bright.exposure_ev, std::log2(1000), 1e-3);
  const auto& a = std::get<base::Image8>(of_dim.image).rgba;
  const auto& b = std::get<base::Image8>(of_bright.image).rgba;
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1);
  request.format = PixelFormat::kLinearFloat;
  EXPECT_EQ(render(request).exposure_ev, 0);
}

TEST_P(Renderer, TilesMeetWithoutASeam) {
  FrameRequest request = request_of(marble_box());
  request.settings.technique = Technique::kLambert;
  request.width_px = 4096 + 100;
  request.height_px = 64;
  request.camera.fov_y_deg = 2;
  request.camera.target = {0, 0, 10};
  const Frame frame = render(request);
  const auto& image = std::get<base::Image8>(frame.image);
  const auto red = [&](uint32_t x) { return static_cast<int>(image.rgba[4 * (32 * size_t{image.width_px} + x)]); };
  for (const uint32_t seam : {2048u, 4096u}) {
    EXPECT_LE(std::abs(red(seam) - red(seam - 1)), 2) << seam;
  }
}

TEST_P(Renderer, MeshesOfOneSceneHideEachOther) {
  auto scene = make_scene(make_box({10, 10, 10}, 4), "marble");
  add_point_light(*scene, {0, 0, 100}, 1e5f);
  FrameRequest request = request_of(scene);
  request.settings.technique = Technique::kLambert;
  request.format = PixelFormat::kLinearFloat;
  const auto alone = std::get<base::ImageF>(render(request).image).values;
  auto front = std::make_shared<scene::Mesh>(*scene->meshes[0]);
  front->name = "scenes/test/meshes/front";
  front->scene_from_mesh[3] = glm::vec4(0, 0, 12, 1);
  scene->materials.push_back(
      {"scenes/test/materials/k", optics::PresetName{"ketchup"}, optics::find_preset("ketchup")->coefficients});
  front->material = "scenes/test/materials/k";
  auto both_scene = std::make_shared<scene::SceneSnapshot>(*scene);
  both_scene->meshes.push_back(front);
  request.scene = both_scene;
  const auto both = std::get<base::ImageF>(render(request).image).values;
  const size_t centre = 4 * (32 * 96 + 48);
  EXPECT_GT(alone[centre + 2], 5 * both[centre + 2]) << "the middle is ketchup now: hardly any blue";
}

}  // namespace
}  // namespace diaphane::render

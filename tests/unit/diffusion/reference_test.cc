#include "diffusion/reference.h"

#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tests/support/meshes.h"
#include "tests/support/rays.h"

namespace diaphane::diffusion {
namespace {

using testing::Mesh;

struct Light {
  glm::vec3 position_mm;
  float intensity_w_sr;
};

class ReferencePoints : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::ifstream scenes(testing::shared_path("reference/scenes.json"));
    if (!scenes) GTEST_SKIP() << "the shared reference scenes are not there";
    const nlohmann::json scene = nlohmann::json::parse(scenes)["scenes"][GetParam()];
    mesh_ = testing::read_obj_gz(testing::shared_path("reference/" + scene["mesh"].get<std::string>()));
    ASSERT_TRUE(mesh_.has_value());
    material_ = optics::find_preset(scene["material"]["name"].get<std::string>())->coefficients;
    const auto& p = scene["light"]["position_mm"];
    light_ = {{p[0], p[1], p[2]}, scene["light"]["radiant_intensity_W_per_sr_each_channel"]};
    std::ifstream points(testing::shared_path("reference/" + scene["files"]["points"].get<std::string>()));
    points_ = nlohmann::json::parse(points)["points"];
  }

  /// E = I Ft cos/d².
  glm::vec3 irradiance(const glm::vec3& position_mm, const glm::vec3& normal) const {
    const glm::vec3 way = light_.position_mm - position_mm;
    const float distance2 = glm::dot(way, way);
    const float cosine = std::max(0.0f, glm::dot(normal, way) / std::sqrt(distance2));
    return glm::vec3(light_.intensity_w_sr * cosine / distance2 *
                     optics::fresnel_transmittance(material_.refractive_index, cosine));
  }

  void expect_agreement(const IrradianceAt& irradiance, const char* field) const {
    const SurfelOptions options{.splits = mesh_->triangles.size() > 100000 ? 1u : 2u};
    const Surfels surfels = sample_surface(mesh_->triangles, mesh_->positions_mm, mesh_->normals, irradiance, options);
    std::vector<glm::vec3> receivers, truth;
    for (const auto& point : points_) {
      receivers.emplace_back(point["p"][0], point["p"][1], point["p"][2]);
      truth.emplace_back(point[field][0], point[field][1], point[field][2]);
    }
    const auto radiosity = reference_radiosity(optics::make_profile(material_), surfels, receivers);
    ASSERT_TRUE(radiosity.ok());
    const glm::vec3 error = testing::relative_rms(*radiosity, truth);
    RecordProperty("worst_channel_percent", std::to_string(100 * std::max({error.x, error.y, error.z})));
    for (int c = 0; c < 3; ++c) EXPECT_LE(error[c], 0.007f) << field << " channel " << c;
  }

  std::optional<Mesh> mesh_;
  optics::Coefficients material_;
  Light light_;
  nlohmann::json points_;
};

TEST_P(ReferencePoints, AgreeWithoutShadows) {
  expect_agreement([&](const glm::vec3& p, const glm::vec3& n) { return irradiance(p, n); }, "B_Ft_unshadowed");
}

TEST_P(ReferencePoints, AgreeWithShadows) {
  const testing::MeshRays rays(*mesh_);
  expect_agreement(
      [&](const glm::vec3& p, const glm::vec3& n) {
        const glm::vec3 e = irradiance(p, n);
        // From just above the surface, where the light is on its outer side.
        return e.x > 0 && rays.sees(p + 1e-3f * n, light_.position_mm) ? e : glm::vec3(0);
      },
      "B_Ft_shadowed");
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReferencePoints,
                         ::testing::Values("sphere_skin1_side", "slab_marble_back", "bunny20_marble_front"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Surfels, CoverTheWholeAreaAtAnySplitting) {
  const Mesh box = testing::make_box({2, 3, 4}, 4);
  for (const uint32_t splits : {1u, 2u, 5u}) {
    const Surfels surfels = sample_surface(box.triangles, box.positions_mm, box.normals,
                                           [](auto&, auto&) { return glm::vec3(1, 2, 0); }, {.splits = splits});
    EXPECT_EQ(surfels.positions_mm.size(), 12u * splits * splits);
    glm::dvec3 flux(0);
    for (const glm::vec3& f : surfels.flux_w) flux += glm::dvec3(f);
    EXPECT_NEAR(flux.x, 52, 1e-4);
    EXPECT_NEAR(flux.y, 104, 1e-4);
    EXPECT_NEAR(surfels.area_mm2, 52, 1e-4);
  }
}

TEST(Surfels, SplitLongEdgesToTheSpacing) {
  const Mesh box = testing::make_box({4, 4, 4}, 4);
  const Surfels surfels = sample_surface(box.triangles, box.positions_mm, box.normals,
                                         [](auto&, auto&) { return glm::vec3(1); }, {.splits = 1, .spacing_mm = 1});
  EXPECT_EQ(surfels.positions_mm.size(), 12u * 6 * 6);  // diagonals of 5.66 mm
}

TEST(Reference, OneSurfelGivesTheDipoleItself) {
  const optics::ReflectanceProfile dipole = optics::make_profile(optics::find_preset("skin1")->coefficients);
  Surfels one;
  one.positions_mm = {{1, 2, 3}};
  one.flux_w = {{2, 3, 5}};
  const std::vector<glm::vec3> receivers = {{1, 2, 3}, {1, 2, 5}, {4, 6, 3}, {1, 42, 3}};
  const auto radiosity = reference_radiosity(dipole, one, receivers, {.threads = 1});
  ASSERT_TRUE(radiosity.ok());
  for (size_t i = 0; i < receivers.size(); ++i) {
    const glm::vec3 expected =
        one.flux_w[0] * optics::diffuse_reflectance(dipole, glm::length(receivers[i] - one.positions_mm[0]));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*radiosity)[i][c], expected[c], 2e-5f * expected[c]) << i << " " << c;
  }
}

TEST(Reference, ReportsProgressToTheEnd) {
  Surfels one;
  one.positions_mm = {{0, 0, 0}};
  one.flux_w = {{1, 1, 1}};
  std::vector<double> told;
  const std::vector<glm::vec3> receivers(7);
  ASSERT_TRUE(reference_radiosity({}, one, receivers, {.progress = [&](double share) { told.push_back(share); }}).ok());
  ASSERT_EQ(told.size(), 7u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
}

TEST(Reference, StopsWhenCancelled) {
  Surfels one;
  one.positions_mm = {{0, 0, 0}};
  one.flux_w = {{1, 1, 1}};
  std::atomic<bool> cancelled = false;
  const std::vector<glm::vec3> receivers(100);
  const auto radiosity = reference_radiosity(
      {}, one, receivers, {.threads = 1, .progress = [&](double) { cancelled = true; }, .cancelled = &cancelled});
  EXPECT_EQ(radiosity.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace diaphane::diffusion

#include "diffusion/dipole_integral.h"

#include <gtest/gtest.h>

#include <cstring>

#include "diffusion/reference.h"
#include "diffusion/simd_level.h"
#include "geometry/topology.h"
#include "glm/geometric.hpp"
#include "optics/presets.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"

namespace diaphane::diffusion {
namespace {

using testing::Mesh;
using testing::PointLight;

std::shared_ptr<const SurfaceTopology> topology_of(const Mesh& mesh) {
  return build_surface_topology(*geometry::build_topology(mesh.positions_mm, mesh.triangles));
}

std::vector<glm::vec3> radiosity_of(DipoleIntegral& integral, const Mesh& mesh, const IrradianceAt& irradiance,
                                    const optics::Coefficients& material, Quality quality = Quality::kFine) {
  const testing::SurfaceIrradiance light =
      testing::light_surface(integral.topology(), mesh.positions_mm, mesh.normals, irradiance);
  integral.update_positions(mesh.positions_mm);
  integral.refit_geometry();
  integral.set_irradiance(light.at_triangles, light.at_vertices);
  integral.refit_flux();
  integral.set_material(material);
  std::vector<glm::vec3> radiosity(mesh.positions_mm.size());
  integral.gather(quality, radiosity);
  return radiosity;
}

optics::Coefficients preset(const char* name) { return optics::find_preset(name)->coefficients; }

const std::vector<PointLight> kFrontLight = {{{25, 30, 40}, glm::vec3(12000)}};
const std::vector<PointLight> kTwoColours = {{{30, 20, 30}, {12000, 3000, 500}}, {{-30, 10, -20}, {300, 2000, 12000}}};

/// Relative RMS error at random points, worst channel.
float error_against_reference(const Mesh& mesh, const std::vector<PointLight>& lights,
                              const optics::Coefficients& material, Quality quality = Quality::kFine) {
  const IrradianceAt irradiance = testing::irradiance_of(lights, material.refractive_index);
  DipoleIntegral integral(topology_of(mesh));
  const std::vector<glm::vec3> radiosity = radiosity_of(integral, mesh, irradiance, material, quality);
  const auto points = testing::random_points(mesh, 300, 7);
  std::vector<glm::vec3> receivers, values;
  for (const testing::SurfacePoint& point : points) {
    receivers.push_back(testing::interpolate(mesh, mesh.positions_mm, point));
    values.push_back(testing::interpolate(mesh, radiosity, point));
  }
  const optics::Dipole dipole = optics::make_dipole(material);
  const glm::vec3& l = dipole.mean_free_path_mm;
  const SurfelOptions sampling{.splits = 1, .spacing_mm = 0.7f * std::min({l.x, l.y, l.z}), .largest_splits = 16};
  const Surfels surfels = sample_surface(mesh.triangles, mesh.positions_mm, mesh.normals, irradiance, sampling);
  const auto truth = reference_radiosity(dipole, surfels, receivers);
  const glm::vec3 error = testing::relative_rms(values, *truth);
  return std::max({error.x, error.y, error.z});
}

struct Cell {
  const char* file;
  const char* material;
};

class IntegralOnSharedMesh : public ::testing::TestWithParam<Cell> {};

TEST_P(IntegralOnSharedMesh, AgreesWithTheReference) {
  auto mesh = testing::read_mesh(testing::shared_path(std::string("data/meshes/") + GetParam().file));
  if (!mesh) GTEST_SKIP() << GetParam().file << " is not there";
  testing::scale_to(*mesh, 20);
  for (const auto& lights : {kFrontLight, kTwoColours}) {
    const float error = error_against_reference(*mesh, lights, preset(GetParam().material));
    RecordProperty("error_percent", std::to_string(100 * error));
    std::printf("%s %s %.3f %%\n", GetParam().file, GetParam().material, 100 * error);
    EXPECT_LE(error, 0.015f);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cells, IntegralOnSharedMesh,
    ::testing::Values(Cell{"bunny_closed_72k.ply", "marble"}, Cell{"hand_7k7.ply", "skin1"},
                      Cell{"demon_standin_goathead_48k.ply", "wholemilk"}, Cell{"fertility_genus4.off", "ketchup"}),
    [](const auto& info) { return std::string(info.param.material); });

}  // namespace
}  // namespace diaphane::diffusion

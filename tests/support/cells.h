// The matrix of meshes, materials and lights on which accuracy is measured.
#pragma once

#include <string>
#include <vector>

#include "optics/dipole.h"
#include "tests/support/lighting.h"
#include "tests/support/meshes.h"

namespace diaphane::testing {

inline const std::vector<std::string> kCellMeshes = {"bunny", "hand", "goathead", "fertility",
                                                     "torus", "cup",  "plate",    "cube"};
inline const std::vector<std::string> kCellMaterials = {"marble", "skin1", "wholemilk", "ketchup"};
inline const std::vector<std::string> kCellLights = {"front", "back", "two"};

/// A mesh of kCellMeshes about the origin, its longest side `extent_mm`. Throws std::runtime_error where there is no
/// such mesh, or its file is absent.
Mesh cell_mesh(const std::string& name, float extent_mm);

/// Lights of kCellLights for a body of that extent. Throws std::runtime_error where there are none of that name.
std::vector<PointLight> cell_lights(const std::string& name, float extent_mm);

/// A preset, or preset+profile, profile one of better-dipole and normalized-diffusion. Throws std::runtime_error where
/// there is none of that name.
optics::Coefficients cell_material(const std::string& name);

/// A cell of the matrix, ready to be measured.
struct Cell {
  std::string mesh_name, material_name, light_name;
  Mesh mesh;
  optics::Coefficients material;
  std::vector<PointLight> lights;
  diffusion::IrradianceAt irradiance;
};
/// The maps of light at hand, by file name without extension; none without the shared data.
std::vector<std::string> environment_names();
/// Throws std::runtime_error where there is none of that name.
optics::LatLongMap environment_map(const std::string& name);

/// `light` is one of kCellLights, or an environment's name: then the cell has no lights, but its irradiance.
Cell make_cell(const std::string& mesh, const std::string& material, const std::string& light, float extent_mm);

/// B of brute force at points of a surface with their normals, W·mm⁻², over surfels of half the shortest mean free path
/// or finer.
std::vector<glm::vec3> true_radiosity(const Mesh& mesh, const optics::Coefficients& material,
                                      const diffusion::IrradianceAt& irradiance,
                                      const std::vector<glm::vec3>& points_mm, const std::vector<glm::vec3>& normals);

}  // namespace diaphane::testing

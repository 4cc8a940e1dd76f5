// A body of one's own coefficients with a light behind it, then a change of both; linear radiance as EXR.
// usage: light_and_material MESH BEFORE.exr AFTER.exr
#include <fstream>
#include <iostream>

#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"

int main(int argc, char** argv) try {
  if (argc != 4) throw std::invalid_argument("give MESH BEFORE.exr AFTER.exr");
  const diaphane::MeshData mesh = diaphane::read_mesh_file(argv[1]).value().meshes[0];
  const diaphane::Bounds bounds = diaphane::bounds_of({&mesh, 1}).value();
  const auto& [low, high] = bounds;

  const auto server = diaphane::PrivateServer::start().value();
  const auto client = diaphane::Client::connect(server.address()).value();
  const auto scene = client.create_scene({.millimetres_per_unit = 20 / (high.y - low.y)}).value();
  const auto jade =
      scene.add_material({diaphane::Coefficients{{0.03f, 0.005f, 0.02f}, {0.9f, 1.2f, 1.0f}, 1.5f}}).value();
  scene.add_mesh(mesh, {.material = jade}).value();
  // Behind the body by half its height; W·sr⁻¹, which falls with the square of the distance in millimetres.
  const diaphane::Vec3 behind{(low.x + high.x) / 2, high.y, low.z - (high.y - low.y) / 2};
  const auto lamp = scene.add_light(diaphane::PointLight{behind, {5000, 4500, 4000}, /*radius_mm=*/2}).value();

  diaphane::RenderOptions options{.camera = diaphane::frame_camera(bounds), .size = {640, 360}};
  options.format = diaphane::ImageFormat::kExr;
  std::ofstream(argv[2], std::ios::binary) << scene.render(options).value().image;
  scene.update_material(jade, {"skin1"}).value();
  scene.update_light(lamp, diaphane::DirectionalLight{{0, -1, -1}, {2, 2, 2}}).value();
  std::ofstream(argv[3], std::ios::binary) << scene.render(options).value().image;
  return 0;
} catch (const std::exception& error) {
  std::cerr << "light_and_material: " << error.what() << "\n";
  return 1;
}

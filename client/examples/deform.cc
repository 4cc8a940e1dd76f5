// Twists a mesh about its vertical axis, a frame a step: only positions travel. usage: deform MESH FOLDER
#include <complex>
#include <fstream>
#include <iostream>

#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("give MESH FOLDER");
  const diaphane::MeshData mesh = diaphane::read_mesh_file(argv[1]).value().meshes[0];
  const diaphane::Bounds bounds = diaphane::bounds_of({&mesh, 1}).value();
  const float height = bounds.highest.y - bounds.lowest.y;

  const auto server = diaphane::PrivateServer::start().value();
  const auto client = diaphane::Client::connect(server.address()).value();
  const auto scene = client.create_scene({.millimetres_per_unit = 20 / height}).value();
  const auto body = scene.add_mesh(mesh, {.material = scene.add_material({"wax"}).value()}).value();
  for (int step = 0; step < 4; ++step) {
    std::vector<diaphane::Vec3> positions = mesh.positions;
    for (auto& [x, y, z] : positions) {
      const std::complex<float> twisted = std::complex(x, z) * std::polar(1.f, 0.5f * step * y / height);
      x = twisted.real(), z = twisted.imag();
    }
    scene.update_positions(body, positions).value();  // normals follow
    const auto frame = scene.render({.camera = diaphane::frame_camera(bounds), .size = {640, 360}}).value();
    std::ofstream(argv[2] + ("/step_" + std::to_string(step) + ".png"), std::ios::binary) << frame.image;
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "deform: " << error.what() << "\n";
  return 1;
}

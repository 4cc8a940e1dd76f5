// One frame of a mesh file, in marble and by the light of a scene that has none. usage: render_frame MESH PICTURE.png
#include <fstream>
#include <iostream>

#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("give MESH PICTURE.png");
  const diaphane::LoadedFile file = diaphane::read_mesh_file(argv[1]).value();
  const diaphane::Bounds bounds = diaphane::bounds_of(file.meshes).value();
  const double millimetres_per_unit = 20 / (bounds.highest.y - bounds.lowest.y);  // translucency depends on real size

  const auto server = diaphane::PrivateServer::start().value();  // Client::connect("HOST:PORT") for one that runs
  const auto client = diaphane::Client::connect(server.address()).value();
  const auto scene = client.create_scene({.millimetres_per_unit = millimetres_per_unit}).value();
  const auto marble = scene.add_material({"marble"}).value();
  for (const diaphane::MeshData& mesh : file.meshes) scene.add_mesh(mesh, {.material = marble}).value();
  const auto frame = scene.render({.camera = diaphane::frame_camera(bounds)}).value();
  std::ofstream(argv[2], std::ios::binary) << frame.image;
  return 0;
} catch (const std::exception& error) {  // value() of a call that failed
  std::cerr << "render_frame: " << error.what() << "\n";
  return 1;
}

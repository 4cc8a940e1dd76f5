// Linear radiance with what it was made of, normals and depth beside it, as one EXR: what compositing programs read.
// usage: save_channels MESH PICTURE.exr
#include <fstream>
#include <iostream>

#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("give MESH PICTURE.exr");
  const diaphane::MeshData mesh = diaphane::read_mesh_file(argv[1]).value().meshes[0];
  const diaphane::Bounds bounds = diaphane::bounds_of({&mesh, 1}).value();

  const auto server = diaphane::PrivateServer::start().value();
  const auto client = diaphane::Client::connect(server.address()).value();
  const auto scene = client.create_scene({.millimetres_per_unit = 20 / (bounds.highest.y - bounds.lowest.y)}).value();
  scene.add_mesh(mesh, {.material = scene.add_material({"skin1"}).value()}).value();

  diaphane::RenderOptions options{.camera = diaphane::frame_camera(bounds), .size = {640, 360}};
  options.format = diaphane::ImageFormat::kExr;
  options.channels = {diaphane::Channel::kIrradiance, diaphane::Channel::kRadiosity, diaphane::Channel::kNormal,
                      diaphane::Channel::kDepth};
  std::ofstream(argv[2], std::ios::binary) << scene.render(options).value().image;
  return 0;
} catch (const std::exception& error) {
  std::cerr << "save_channels: " << error.what() << "\n";
  return 1;
}

// A wave runs through a body while somebody watches: edits from one thread, frames to another. usage: live MESH FOLDER
#include <atomic>
#include <cmath>
#include <fstream>
#include <iostream>
#include <thread>

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

  std::atomic<uint64_t> last_revision{UINT64_MAX};
  std::jthread program([&] {
    diaphane::Deformer deformer = scene.deform();
    for (int step = 0; step < 20; ++step) {
      std::vector<diaphane::Vec3> positions = mesh.positions;
      for (auto& [x, y, z] : positions) x += 0.1f * height * std::sin(6 * y / height + 0.3f * static_cast<float>(step));
      if (!deformer.set_positions(body, positions).ok()) break;  // flush() says why
    }
    last_revision = deformer.flush().value_or(0);
  });

  diaphane::FrameStream stream = scene.stream({.view = {.camera = diaphane::frame_camera(bounds), .size = {640, 360}}});
  while (true) {
    const diaphane::StreamedFrame shown = stream.next().value();
    if (!shown.at_rest || shown.frame.scene_revision < last_revision) continue;
    std::ofstream(argv[2] + std::string("/at_rest.png"), std::ios::binary) << shown.frame.image;
    return 0;
  }
} catch (const std::exception& error) {
  std::cerr << "live: " << error.what() << "\n";
  return 1;
}

// Renders a tetrahedron by the installed library and server, and says how many bytes of PNG it got.
#include <cstdio>
#include <exception>

#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"

int main() try {
  const diaphane::PrivateServer server = diaphane::PrivateServer::start({.program = DIAPHANE_SERVER}).value();
  const diaphane::Client client = diaphane::Client::connect(server.address()).value();
  const diaphane::Scene scene = client.create_scene({.millimetres_per_unit = 10}).value();
  const diaphane::MaterialHandle wax = scene.add_material({"wax"}).value();
  const diaphane::MeshData body{.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                .triangles = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}};
  scene.add_mesh(body, {.material = wax}).value();
  const diaphane::Camera camera = diaphane::frame_camera(diaphane::bounds_of({&body, 1}).value());
  const diaphane::RenderedFrame frame = scene.render({.camera = camera, .size = {160, 90}}).value();
  std::printf("%s: %zu bytes\n", frame.content_type.c_str(), frame.image.size());
  return frame.image.starts_with("\x89PNG") ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "consumer: %s\n", error.what());
  return 1;
}

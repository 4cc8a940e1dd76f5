// Morphs a mesh to its bounding sphere in wax that is lit from behind, as the paper's Fig. 10 does, by both techniques:
// thin parts glow.
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "album.h"
#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"
#include "fmt/format.h"
#include "gallery/morph.h"

namespace {

using namespace diaphane;
namespace fs = std::filesystem;

constexpr double kHeightMm = 14;   // some sixteen mean free paths of the wax
constexpr float kRadiance = 0.6f;  // W·mm⁻²·sr⁻¹ of a white wall as far from the light as the middle of the body
constexpr float kExposureEv = 3.7f;  // what comes through the body is far darker than the wall
// The paper's global term is dark beyond a few mean free paths; this shows its shape.
constexpr float kGlobalGain = 1000;

struct Options {
  fs::path mesh;
  fs::path folder;
  std::string server;
  uint32_t frames = 24;
  std::string size = "512x512";
};

void show_progress(uint32_t done, uint32_t total) {
  if (isatty(STDERR_FILENO) == 0) return;
  const uint32_t filled = 40 * done / total;
  std::cerr << fmt::format("\r[{:#<{}}{:.<{}}] {}/{}", "", filled, "", 40 - filled, done, total)
            << (done == total ? "\n" : "") << std::flush;
}

using Seconds = std::chrono::duration<double>;

absl::Status run(const Options& options) {
  absl::StatusOr<LoadedFile> file = read_mesh_file(options.mesh);
  if (!file.ok()) return file.status();
  const MeshData mesh = gallery::merged(file->meshes);
  const absl::StatusOr<Bounds> bounds = bounds_of({&mesh, 1});
  if (!bounds.ok()) return bounds.status();
  const float height = bounds->highest.y - bounds->lowest.y;
  if (!(height > 0)) return absl::InvalidArgumentError("the mesh has no height");
  const double millimetres_per_unit = kHeightMm / height;
  const absl::StatusOr<gallery::Sphere> sphere = gallery::bounding_sphere(mesh);
  if (!sphere.ok()) return sphere.status();
  const auto& [c, r] = *sphere;

  RenderOptions render;
  char x = 0;
  std::istringstream size(options.size);
  if (!(size >> render.size.width_px >> x >> render.size.height_px) || x != 'x' || render.size.height_px == 0) {
    return absl::InvalidArgumentError(fmt::format("--size: must be WxH, got '{}'", options.size));
  }
  // The sphere must fit too: it is what the mesh becomes.
  render.camera = frame_camera({{c.x - r, c.y - r, c.z - r}, {c.x + r, c.y + r, c.z + r}},
                               {.aspect = static_cast<float>(render.size.width_px) / render.size.height_px, .fill = 1});
  // Behind, where what faces the camera does not face it, near the body but outside the sphere.
  const PointLight light = [&] {
    const float y = 0.35f * r;
    const float z = -1.02f * r;
    const double distance_mm = std::hypot(y, z) * millimetres_per_unit;
    const auto intensity = static_cast<float>(kRadiance * M_PI * distance_mm * distance_mm);
    return PointLight{{c.x, c.y + y, c.z + z}, {intensity, intensity, intensity}};
  }();

  std::optional<PrivateServer> server;
  std::string address = options.server;
  if (address.empty()) {
    absl::StatusOr<PrivateServer> started = PrivateServer::start();
    if (!started.ok()) return started.status();
    server = *std::move(started);
    address = server->address();
  }
  const absl::StatusOr<Client> client = Client::connect(address);
  if (!client.ok()) return client.status();
  const absl::StatusOr<Scene> scene =
      client->create_scene({.display_name = "demo", .millimetres_per_unit = millimetres_per_unit});
  if (!scene.ok()) return scene.status();
  const auto delete_scene = std::shared_ptr<void>(nullptr, [&](void*) { (void)scene->remove(); });
  const absl::StatusOr<MaterialHandle> wax = scene->add_material({"wax"});
  if (!wax.ok()) return wax.status();
  if (const auto handle = scene->add_light(light); !handle.ok()) return handle.status();
  const absl::StatusOr<MeshHandle> body = scene->add_mesh(mesh, {.material = *wax});
  if (!body.ok()) return body.status();
  render.settings.exposure_ev = kExposureEv;
  RenderOptions paper = render;
  paper.settings.technique = Technique::kPaper;
  paper.settings.paper.global_gain = kGlobalGain;
  render.settings.technique = Technique::kIntegral;
  // The first frames compile shaders; they are not timed.
  for (const RenderOptions& first : {render, paper}) {
    if (const auto frame = scene->render(first); !frame.ok()) return frame.status();
  }

  absl::StatusOr<examples::Album> album = examples::Album::open(options.folder, render.size);
  if (!album.ok()) return album.status();
  Seconds integral_seconds{0};
  for (uint32_t i = 0; i < options.frames; ++i) {
    const float t = options.frames > 1 ? static_cast<float>(i) / static_cast<float>(options.frames - 1) : 0;
    const std::vector<Vec3> positions = gallery::morphed(mesh.positions, *sphere, t);
    const auto start = std::chrono::steady_clock::now();
    const auto revision = scene->update_positions(*body, positions);
    if (!revision.ok()) return revision.status();
    const absl::StatusOr<RenderedFrame> integral_frame = scene->render(render);
    if (!integral_frame.ok()) return integral_frame.status();
    integral_seconds += std::chrono::steady_clock::now() - start;
    const absl::StatusOr<RenderedFrame> paper_frame = scene->render(paper);
    if (!paper_frame.ok()) return paper_frame.status();
    if (absl::Status added = album->add(*integral_frame, *paper_frame); !added.ok()) return added;
    show_progress(i + 1, options.frames);
  }
  if (absl::Status finished = album->finish(); !finished.ok()) return finished;
  for (const std::string& note : album->notes()) std::cerr << "diaphane-demo: " << note << "\n";
  std::cout << fmt::format(
      "{} frames by each technique, and {} (integral, then paper), in {}: {:.1f} frames per second, new positions in "
      "each\n",
      options.frames, fmt::join(album->files(), ", "), options.folder.string(),
      options.frames / integral_seconds.count());
  return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Morphs a mesh to its bounding sphere in wax that is lit from behind."};
  app.add_option("MESH", options.mesh)->required();
  app.add_option("OUTDIR", options.folder)->required();
  app.add_option("--server", options.server, "HOST:PORT or unix:PATH (default: a private server)");
  app.add_option("--frames", options.frames)->check(CLI::Range(1u, 999u));
  app.add_option("--size", options.size, "WxH");
  CLI11_PARSE(app, argc, argv);
  std::error_code code;
  fs::create_directories(options.folder, code);
  const absl::Status status =
      code ? absl::InternalError(fmt::format("{}: {}", options.folder.string(), code.message())) : run(options);
  if (!status.ok()) std::cerr << "diaphane-demo: " << std::string(status.message()) << "\n";
  return status.ok() ? 0 : 1;
}

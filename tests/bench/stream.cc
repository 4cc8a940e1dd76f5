// A deforming scene through a server in another process: what comes back, how fast, and where the time goes.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "CLI/CLI.hpp"
#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"
#include "nlohmann/json.hpp"
#include "render/gl_renderer.h"
#include "tests/bench/in_process.h"

namespace diaphane {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char *kFloat32 = "float32", *kQuantized = "16bit";

constexpr std::chrono::milliseconds kPause{10};

struct Settings {
  std::vector<std::string> meshes = {"bunny_closed_72k.ply", "buddha_381k.ply"};
  std::string folder = "../shared/data/meshes";
  std::vector<std::string> sizes = {"512x512", "1280x720"};
  std::vector<std::string> forms = {kFloat32, kQuantized};
  int frames = 60;
  std::string json_path;
};

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

/// What is deformed, and how its positions travel.
struct Body {
  const MeshData& mesh;
  MeshHandle handle;
  Bounds bounds;
  bool quantized = false;

  absl::Status send(Deformer& deformer, std::span<const Vec3> positions) const {
    if (!quantized) return deformer.set_positions(handle, positions);
    const float reach = 0.1f * (bounds.highest.y - bounds.lowest.y);
    return deformer.set_quantized_positions(handle, positions,
                                            {bounds.lowest.x - reach, bounds.lowest.y, bounds.lowest.z},
                                            {bounds.highest.x + reach, bounds.highest.y, bounds.highest.z});
  }
};

/// `pose` as a program has it that makes it where it is sent from; one that sends 16 bits has memory of its own.
std::span<const Vec3> made(const Body& body, const std::vector<Vec3>& pose, Deformer& deformer) {
  if (body.quantized) return pose;
  const std::span<Vec3> positions = deformer.positions_buffer(pose.size());
  std::copy(pose.begin(), pose.end(), positions.begin());
  return positions;
}

/// Leaning to and fro about the lowest point.
std::vector<Vec3> leaning(const Body& body, int frame) {
  const float lean = 0.1f * std::sin(0.3f * static_cast<float>(frame));
  std::vector<Vec3> positions = body.mesh.positions;
  for (Vec3& p : positions) p.x += lean * (p.y - body.bounds.lowest.y);
  return positions;
}

struct Measured {
  std::vector<double> latency_ms, in_process_ms, overhead_ms, encode_ms, rest_ms;
  std::map<std::string, std::vector<double>> stages_ms;
  double frames_per_second = 0;
};

/// One edit, then the frame that shows it, then the same frame in this process, and so on: nothing waits for anything
/// else.
absl::Status measure_latency(const Scene& scene, const Body& body, const StreamOptions& options,
                             bench::InProcess& in_process, int frames, Measured* out) {
  FrameStream stream = scene.stream(options);
  Deformer deformer = scene.deform();
  for (int i = -3; i < frames; ++i) {
    const std::vector<Vec3> positions = leaning(body, i);
    const std::span<const Vec3> to_send = made(body, positions, deformer);
    const Clock::time_point begin = Clock::now();
    if (absl::Status sent = body.send(deformer, to_send); !sent.ok()) return sent;
    const absl::StatusOr<uint64_t> revision = deformer.flush();
    if (!revision.ok()) return revision.status();
    absl::StatusOr<StreamedFrame> frame = stream.next();
    while (frame.ok() && frame->frame.scene_revision < *revision) frame = stream.next();
    if (!frame.ok()) return frame.status();
    const double latency = ms_since(begin);
    const absl::StatusOr<double> here = in_process.frame_ms(positions, options.view.camera, options.view.size);
    if (!here.ok()) return here.status();
    // A client has no renderer: this one's threads look for work a while before they sleep.
    std::this_thread::sleep_for(kPause);
    if (i < 0) continue;
    double encode = 0;
    for (const StageTime& stage : frame->frame.stages) {
      if (stage.stage == "encode") encode = stage.milliseconds;
      if (stage.stage != "queue") out->stages_ms[stage.stage].push_back(stage.milliseconds);
    }
    out->latency_ms.push_back(latency);
    out->in_process_ms.push_back(*here);
    out->overhead_ms.push_back(latency - encode - *here);
    out->encode_ms.push_back(encode);
  }
  return absl::OkStatus();
}

/// From the last of some edits to the lossless frame.
absl::Status measure_rest(const Scene& scene, const Body& body, StreamOptions options, Measured* out) {
  options.view.lossless_at_rest = true;
  FrameStream stream = scene.stream(options);
  Deformer deformer = scene.deform();
  for (int i = 0; i < 5; ++i) {
    if (absl::Status sent = body.send(deformer, made(body, leaning(body, i), deformer)); !sent.ok()) return sent;
    const absl::StatusOr<uint64_t> revision = deformer.flush();
    if (!revision.ok()) return revision.status();
    const Clock::time_point begin = Clock::now();
    absl::StatusOr<StreamedFrame> frame = stream.next();
    while (frame.ok() && !(frame->at_rest && frame->frame.scene_revision == *revision)) frame = stream.next();
    if (!frame.ok()) return frame.status();
    out->rest_ms.push_back(ms_since(begin));
  }
  return absl::OkStatus();
}

/// Edits as fast as the server takes them, frames as fast as they come.
absl::Status measure_rate(const Scene& scene, const Body& body, const StreamOptions& options, int frames,
                          Measured* out) {
  FrameStream stream = scene.stream(options);
  std::atomic<bool> done{false};
  std::thread program([&] {
    Deformer deformer = scene.deform();
    std::vector<std::vector<Vec3>> poses;
    for (int i = 0; i < 8; ++i) poses.push_back(leaning(body, 3 * i));
    for (size_t i = 0; !done; ++i) {
      if (!body.send(deformer, made(body, poses[i % poses.size()], deformer)).ok() || !deformer.flush().ok()) return;
    }
  });
  absl::Status status;
  Clock::time_point begin = Clock::now();
  for (int i = -3; i < frames && status.ok(); ++i) {
    if (i == 0) begin = Clock::now();
    status = stream.next().status();
  }
  out->frames_per_second = 1000.0 * frames / ms_since(begin);
  done = true;
  program.join();
  return status;
}

/// One row of the table: `size` is WIDTHxHEIGHT, `form` as Settings has it.
absl::StatusOr<nlohmann::json> measure(const Client& client, render::FrameRenderer& renderer, const MeshData& mesh,
                                       const std::string& size, const std::string& form, int frames) {
  const Bounds bounds = *bounds_of({&mesh, 1});
  const double millimetres_per_unit = 50 / (bounds.highest.y - bounds.lowest.y);
  const absl::StatusOr<Scene> scene = client.create_scene({.millimetres_per_unit = millimetres_per_unit});
  if (!scene.ok()) return scene.status();
  const auto material = scene->add_material({"marble"});
  const auto handle = scene->add_mesh(mesh, {.material = material.value_or(MaterialHandle{})});
  if (!handle.ok()) return handle.status();
  StreamOptions options;
  options.view.size = {static_cast<uint32_t>(std::stoul(size)),
                       static_cast<uint32_t>(std::stoul(size.substr(size.find('x') + 1)))};
  options.view.camera = frame_camera(bounds);
  options.view.lossless_at_rest = false;
  const Vec3& eye = options.view.camera.eye;
  const PointLight lamp{{eye.x + 1, eye.y + 1, eye.z}, {20000, 20000, 20000}};
  const auto light = scene->add_light(lamp);
  if (!light.ok()) return light.status();
  bench::InProcess in_process(renderer, mesh, millimetres_per_unit, lamp);
  const Body body{mesh, *handle, bounds, form == kQuantized};
  Measured measured;
  absl::Status status = measure_latency(*scene, body, options, in_process, frames, &measured);
  if (status.ok()) status = measure_rest(*scene, body, options, &measured);
  if (status.ok()) status = measure_rate(*scene, body, options, frames, &measured);
  if (status.ok()) status = scene->remove();
  if (!status.ok()) return status;
  const auto p50_and_p99 = [](const std::vector<double>& values) {
    return nlohmann::json{{"p50", quantile(values, 0.5)}, {"p99", quantile(values, 0.99)}};
  };
  nlohmann::json row{{"size", size},
                     {"form", form},
                     {"frames_per_second", measured.frames_per_second},
                     {"latency_ms", p50_and_p99(measured.latency_ms)},
                     {"in_process_ms", quantile(measured.in_process_ms, 0.5)},
                     {"encode_ms", quantile(measured.encode_ms, 0.5)},
                     {"beyond_ms", p50_and_p99(measured.overhead_ms)},
                     {"rest_ms", quantile(measured.rest_ms, 0.5)},
                     {"positions_bytes", (body.quantized ? 6 : 12) * mesh.positions.size()},
                     {"stages_ms", nlohmann::json::object()}};
  for (const auto& [stage, values] : measured.stages_ms) row["stages_ms"][stage] = quantile(values, 0.5);
  return row;
}

void print_row(const nlohmann::json& row) {
  const auto number = [&](const char* name) { return row[name].get<double>(); };
  const auto text = [&](const char* name) { return row[name].get<std::string>(); };
  std::printf("%-22s %-9s %-7s | %6.1f | %8.2f %8.2f | %8.2f | %7.2f | %7.2f %7.2f | %6.0f\n", text("mesh").c_str(),
              text("size").c_str(), text("form").c_str(), number("frames_per_second"),
              row["latency_ms"]["p50"].get<double>(), row["latency_ms"]["p99"].get<double>(), number("in_process_ms"),
              number("encode_ms"), row["beyond_ms"]["p50"].get<double>(), row["beyond_ms"]["p99"].get<double>(),
              number("rest_ms"));
  std::fflush(stdout);
}

absl::Status run(const Settings& settings) {
  const auto renderer = render::make_gl_renderer({});
  if (!renderer.ok()) return renderer.status();
  const absl::StatusOr<PrivateServer> server = PrivateServer::start();
  if (!server.ok()) return server.status();
  const absl::StatusOr<Client> client = Client::connect(server->address());
  if (!client.ok()) return client.status();
  std::printf(
      "Dense positions of every frame to a server in another process, JPEG (quality 80) back, marble, integral "
      "normal,\n"
      "medians of %d, ms. Latency: from the call that sends new positions to the frame that shows them. Here: the "
      "same\n"
      "frame by the renderer in this process, after it. Beyond: latency without that and without encoding. Rest: from "
      "the\n"
      "last edit to the lossless PNG.\n",
      settings.frames);
  std::printf("%-22s %-9s %-7s | %6s | %8s %8s | %8s | %7s | %7s %7s | %6s\n", "mesh", "size", "form", "fps", "latency",
              "p99", "here", "encode", "beyond", "p99", "rest");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& name : settings.meshes) {
    const absl::StatusOr<LoadedFile> file = read_mesh_file(settings.folder + "/" + name);
    if (!file.ok()) return file.status();
    for (const std::string& size : settings.sizes) {
      for (const std::string& form : settings.forms) {
        auto row = measure(*client, **renderer, file->meshes.front(), size, form, settings.frames);
        if (!row.ok()) return row.status();
        (*row)["mesh"] = name;
        print_row(*row);
        rows.push_back(*std::move(row));
      }
    }
  }
  for (const nlohmann::json& row : rows) {
    std::printf("%s %s %s:", row["mesh"].get<std::string>().c_str(), row["size"].get<std::string>().c_str(),
                row["form"].get<std::string>().c_str());
    for (const auto& [stage, value] : row["stages_ms"].items())
      std::printf(" %s %.2f", stage.c_str(), value.get<double>());
    std::printf("\n");
  }
  if (!settings.json_path.empty()) std::ofstream(settings.json_path) << nlohmann::json{{"rows", rows}}.dump(1) << "\n";
  return absl::OkStatus();
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Frames and latency of a deforming scene over loopback");
  app.add_option("--meshes", settings.meshes, "files of --folder")->delimiter(',');
  app.add_option("--folder", settings.folder, "with mesh files");
  app.add_option("--sizes", settings.sizes, "WIDTHxHEIGHT")->delimiter(',');
  app.add_option("--forms", settings.forms, "of positions")
      ->delimiter(',')
      ->check(CLI::IsMember({diaphane::kFloat32, diaphane::kQuantized}));
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 100000));
  app.add_option("--json", settings.json_path, "file for the table");
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = diaphane::run(settings);
  if (!status.ok()) std::fprintf(stderr, "bench_stream: %s\n", std::string(status.message()).c_str());
  return status.ok() ? 0 : 1;
}
